"""Monitors a fleet on Spark from a topic of Kafka, and writes events and errors to another. Not run by the tests.

    spark-submit --packages org.apache.spark:spark-sql-kafka-0-10_2.13:4.0.1 spark_kafka.py \\
        BROKERS READINGS TOLD VESSELS CHECKPOINT

Each message of READINGS has the cylinder as its key and a reading as JSON:
{"time": "2026-11-28T06:00:00Z", "shoulder_degc": 11.2, "pressure_bar": 188.4}. VESSELS is a CSV file with the columns of
`cylwatch fleet --vessels`; give it `lateness_s` if gateways send what they have stored.

Keyed state and offsets are exactly once. What is written to Kafka is at least once, as always with Spark: after a crash a message may
come twice, with the same `id`.
"""

import sys

from cylwatch import spark as cylwatch_spark
from pyspark.sql import SparkSession
from pyspark.sql import functions as F

READING = "time timestamp, shoulder_degc double, valve_degc double, pressure_bar double"


def main(brokers: str, readings: str, told_topic: str, vessels: str, checkpoint: str) -> None:
    session = SparkSession.builder.config(cylwatch_spark.PROVIDER, cylwatch_spark.ROCKSDB).getOrCreate()
    source = session.readStream.format("kafka").option("kafka.bootstrap.servers", brokers)
    messages = source.option("subscribe", readings).option("startingOffsets", "earliest").load()
    reading = F.from_json(F.col("value").cast("string"), READING)
    logs = messages.select(F.col("key").cast("string").alias("cylinder"), reading.alias("reading")).select("cylinder", "reading.*")
    told = cylwatch_spark.monitor(logs, session.read.csv(vessels, header=True))

    # An error has the same form as an event, so that one topic carries both.
    failed = F.struct(F.lit("error").alias("event"), "error.*")
    lines = F.concat(F.transform("events", lambda event: event.line), F.array_compact(F.array(F.when(F.col("error").isNotNull(), F.to_json(failed)))))
    out = told.select(F.col("cylinder").alias("key"), F.explode(lines).alias("value")).writeStream.format("kafka")
    out = out.option("kafka.bootstrap.servers", brokers).option("topic", told_topic)
    out.option("checkpointLocation", checkpoint).trigger(processingTime="10 seconds").start().awaitTermination()


if __name__ == "__main__":
    main(*sys.argv[1:])
