"""Monitors a fleet on Spark from a folder of Parquet files that grows.

    python spark_files.py LOGS VESSELS OUT [--every "1 minute"] [--files 100]

LOGS has Parquet files with the columns cylinder, time (a timestamp) or time_s, and readings such as shoulder_degc and pressure_bar;
VESSELS is a CSV file with the columns of `cylwatch fleet --vessels`. What has come since the last run is taken in; with --every the job
stays and looks again. It may be killed at any time: OUT/checkpoint makes what it has told, in OUT/told, exactly once.
"""

import argparse

from cylwatch import spark as cylwatch_spark
from pyspark.sql import SparkSession


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("logs")
    parser.add_argument("vessels")
    parser.add_argument("out")
    parser.add_argument("--every", help="stay, and look for files at this interval")
    parser.add_argument("--files", type=int, default=100, help="most files of a micro-batch")
    given = parser.parse_args()

    session = SparkSession.builder.config(cylwatch_spark.PROVIDER, cylwatch_spark.ROCKSDB).getOrCreate()
    schema = session.read.parquet(given.logs).schema
    logs = session.readStream.schema(schema).option("maxFilesPerTrigger", given.files).parquet(given.logs)
    vessels = session.read.csv(given.vessels, header=True)
    told = cylwatch_spark.monitor(logs, vessels)

    writer = told.writeStream.format("parquet").option("checkpointLocation", f"{given.out}/checkpoint")
    trigger = {"processingTime": given.every} if given.every else {"availableNow": True}
    writer.trigger(**trigger).start(f"{given.out}/told").awaitTermination()


if __name__ == "__main__":
    main()
