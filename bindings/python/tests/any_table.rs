//! No table of Arrow makes the reader panic, and the numbers that it takes are those of the table.
//!
//! `PROPTEST_CASES=10000000 cargo test --release -p cylwatch-python` draws as many tables as that; 1000 by default.
#![allow(clippy::unwrap_used)]
#[path = "../src/arrow/table.rs"]
#[allow(dead_code)]
mod table;

use arrow_array::cast::AsArray;
use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::types::*;
use arrow_array::*;
use arrow_schema::{ArrowError, DataType, Field, Schema};
use cylwatch::log::{Cells, LogOptions, LogReader, MemoryLog};
use proptest::prelude::*;
use proptest::sample::select;
use std::sync::Arc;

/// What messages call the table.
const FRAME: &str = "<frame>";
/// Names that mean something, and others.
const NAMES: [&str; 20] = [
    "time",
    "time_s",
    "time_h",
    "time_d",
    "Time",
    "date",
    "clock",
    "shoulder_degc",
    "shoulder_k",
    "valve_degf",
    "pressure_bar",
    "pressure_barg",
    "pressure",
    "ambient_degc",
    "wall_middle_degc",
    "gas_1_degc",
    "T [°C]",
    "",
    "_bar",
    "note\n",
];
/// Zones of stamps, two of which do not exist.
const ZONES: [Option<&str>; 6] =
    [None, Some("UTC"), Some("Europe/Berlin"), Some("+05:30"), Some("Nowhere/None"), Some("\u{0}")];

/// A value of a column before it has a type: bits, or nothing.
type Drawn = Vec<Option<u64>>;

fn primitive<T: ArrowPrimitiveType>(drawn: &Drawn, of: impl Fn(u64) -> T::Native) -> ArrayRef {
    Arc::new(drawn.iter().map(|bits| bits.map(&of)).collect::<PrimitiveArray<T>>())
}

fn stamp<T: ArrowTimestampType>(drawn: &Drawn, zone: Option<&str>) -> ArrayRef {
    // Mostly of this century.
    let tick = |bits: u64| match bits % 4 {
        0 => bits as i64,
        _ => (bits % 4_000_000_000) as i64,
    };
    let ticks: PrimitiveArray<T> = drawn.iter().map(|bits| bits.map(tick)).collect();
    Arc::new(ticks.with_timezone_opt(zone))
}

fn text(bits: u64) -> String {
    match bits % 6 {
        0 => String::new(),
        1 => format!("{}", f64::from_bits(bits)),
        2 => format!("{},5", bits % 100),
        3 => format!("2026-11-{:02}T{:02}:00:00Z", bits / 7 % 40, bits / 11 % 30),
        4 => String::from_utf8_lossy(&bits.to_le_bytes()).into_owned(),
        _ => "n/a".to_owned(),
    }
}

/// An array of the kind with the number.
fn array(kind: usize, drawn: &Drawn, zone: Option<&str>) -> ArrayRef {
    let texts = || drawn.iter().map(|bits| bits.map(text));
    match kind {
        0 => primitive::<Int8Type>(drawn, |bits| bits as i8),
        1 => primitive::<Int16Type>(drawn, |bits| bits as i16),
        2 => primitive::<Int32Type>(drawn, |bits| bits as i32),
        3 => primitive::<Int64Type>(drawn, |bits| bits as i64),
        4 => primitive::<UInt8Type>(drawn, |bits| bits as u8),
        5 => primitive::<UInt16Type>(drawn, |bits| bits as u16),
        6 => primitive::<UInt32Type>(drawn, |bits| bits as u32),
        7 => primitive::<UInt64Type>(drawn, |bits| bits),
        8 => primitive::<Float16Type>(drawn, |bits| {
            <Float16Type as ArrowPrimitiveType>::Native::from_bits(bits as u16)
        }),
        9 => primitive::<Float32Type>(drawn, |bits| f32::from_bits(bits as u32)),
        10 => primitive::<Float64Type>(drawn, f64::from_bits),
        11 => primitive::<Float64Type>(drawn, |bits| (bits % 40_000) as f64 / 100.0),
        12 => Arc::new(drawn.iter().map(|bits| bits.map(|bits| bits % 2 == 0)).collect::<BooleanArray>()),
        13 => Arc::new(texts().collect::<StringArray>()),
        14 => Arc::new(texts().collect::<LargeStringArray>()),
        15 => Arc::new(texts().collect::<StringViewArray>()),
        16 => Arc::new(NullArray::new(drawn.len())),
        17 => stamp::<TimestampSecondType>(drawn, zone),
        18 => stamp::<TimestampMillisecondType>(drawn, zone),
        19 => stamp::<TimestampMicrosecondType>(drawn, zone),
        20 => stamp::<TimestampNanosecondType>(drawn, zone),
        21 => primitive::<Date32Type>(drawn, |bits| bits as i32),
        22 => primitive::<DurationSecondType>(drawn, |bits| bits as i64),
        23 => primitive::<Decimal128Type>(drawn, i128::from),
        24 => Arc::new(
            texts().collect::<Vec<_>>().iter().map(Option::as_deref).collect::<DictionaryArray<Int32Type>>(),
        ),
        25 => Arc::new(ListArray::from_iter_primitive::<Int32Type, _, _>(
            drawn.iter().map(|bits| bits.map(|bits| vec![Some(bits as i32)])),
        )),
        _ => Arc::new(
            drawn
                .iter()
                .map(|bits| bits.map(u64::to_le_bytes))
                .collect::<Vec<_>>()
                .iter()
                .map(|bits| bits.as_ref().map(|bits| &bits[..]))
                .collect::<BinaryArray>(),
        ),
    }
}

/// Kinds of [`array`].
const KINDS: usize = 27;

fn drawn(rows: usize) -> impl Strategy<Value = Drawn> {
    let rising = (0_u64..100_000, 1_u64..9000)
        .prop_map(move |(first, step)| (0..rows as u64).map(|k| Some(first + k * step)).collect());
    prop_oneof![rising, prop::collection::vec(prop::option::weighted(0.9, any::<u64>()), rows)]
}

/// A table in batches, each cut out of a longer one: mostly with a time and a reading, and with others.
fn tables() -> impl Strategy<Value = (Arc<Schema>, Vec<RecordBatch>)> {
    let column = |names: Vec<&'static str>, kinds: Vec<usize>| {
        prop::option::weighted(0.9, (select(names), select(kinds), select(&ZONES[..]), drawn(24)))
    };
    let numbers = (0..12).chain([13]).collect();
    let time = prop_oneof![
        column(vec!["time_s", "time_h"], vec![2, 3, 6, 10, 11, 13]),
        column(vec!["time"], vec![13, 14, 15, 17, 18, 19, 20])
    ];
    let reading = column(vec!["shoulder_degc", "pressure_bar"], numbers);
    let other = (select(&NAMES[..]), 0..KINDS, select(&ZONES[..]), drawn(24));
    let columns = (time, reading, prop::collection::vec(other, 0..3));
    let cuts = prop::collection::vec((0_usize..24, 0_usize..24), 0..3);
    (columns, cuts).prop_map(|((time, reading, others), cuts)| {
        let mut fields = Vec::new();
        let mut arrays = Vec::new();
        for (name, kind, zone, drawn) in time.iter().chain(&reading).chain(&others) {
            let array = array(*kind, drawn, *zone);
            fields.push(Field::new(*name, array.data_type().clone(), true));
            arrays.push(array);
        }
        let schema = Arc::new(Schema::new(fields));
        let options = RecordBatchOptions::new().with_row_count(Some(24));
        let whole = RecordBatch::try_new_with_options(schema.clone(), arrays, &options).unwrap();
        let batches = cuts.iter().map(|(at, length)| whole.slice(*at, (*length).min(24 - at))).collect();
        (schema, batches)
    })
}

/// Through the C interface and back, as from another library.
fn handed_over(schema: &Arc<Schema>, batches: &[RecordBatch]) -> Result<MemoryLog, ArrowError> {
    let batches: Vec<Result<RecordBatch, ArrowError>> = batches.iter().cloned().map(Ok).collect();
    let stream = FFI_ArrowArrayStream::new(Box::new(RecordBatchIterator::new(batches, schema.clone())));
    Ok(MemoryLog { name: FRAME.to_owned(), columns: table::read(stream)? })
}

/// The number at a place, by Arrow's own accessors.
fn number(array: &ArrayRef, at: usize) -> f64 {
    let array = array.as_ref();
    if array.is_null(at) {
        return f64::NAN;
    }
    match array.data_type() {
        DataType::Int8 => f64::from(array.as_primitive::<Int8Type>().value(at)),
        DataType::Int16 => f64::from(array.as_primitive::<Int16Type>().value(at)),
        DataType::Int32 => f64::from(array.as_primitive::<Int32Type>().value(at)),
        DataType::Int64 => array.as_primitive::<Int64Type>().value(at) as f64,
        DataType::UInt8 => f64::from(array.as_primitive::<UInt8Type>().value(at)),
        DataType::UInt16 => f64::from(array.as_primitive::<UInt16Type>().value(at)),
        DataType::UInt32 => f64::from(array.as_primitive::<UInt32Type>().value(at)),
        DataType::UInt64 => array.as_primitive::<UInt64Type>().value(at) as f64,
        DataType::Float16 => f64::from(array.as_primitive::<Float16Type>().value(at)),
        DataType::Float32 => f64::from(array.as_primitive::<Float32Type>().value(at)),
        DataType::Float64 => array.as_primitive::<Float64Type>().value(at),
        // A column of nothing but nulls.
        _ => f64::NAN,
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: ProptestConfig::default().cases.max(1000), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_table_is_read_or_refused_in_one_line((schema, batches) in tables(), any_order: bool) {
        let log = match handed_over(&schema, &batches) {
            Ok(log) => log,
            Err(error) => {
                prop_assert!(!error.to_string().contains('\n'), "{error}");
                return Ok(());
            }
        };
        prop_assert_eq!(log.columns.len(), schema.fields().len());
        let rows: usize = batches.iter().map(RecordBatch::num_rows).sum();
        for (column, (_, cells)) in log.columns.iter().enumerate() {
            if let Cells::Other(_) = cells {
                continue;
            }
            prop_assert_eq!(cells.len(), rows);
            if let Cells::Numbers(numbers) = cells {
                let theirs = batches.iter().flat_map(|batch| {
                    (0..batch.num_rows()).map(move |at| number(batch.column(column), at))
                });
                let same = |(ours, theirs): (&f64, f64)| *ours == theirs || (ours.is_nan() && theirs.is_nan());
                prop_assert!(numbers.iter().zip(theirs).all(same), "{:?}", schema.field(column));
            }
        }
        let read = LogReader::from_memory(log, &LogOptions { any_order, ..LogOptions::default() }).and_then(|mut reader| {
            while reader.next_row()?.is_some() {}
            Ok(())
        });
        if let Err(error) = read {
            let message = error.to_string();
            prop_assert!(message.starts_with(FRAME) && !message.contains('\n'), "{message}");
        }
    }
}
