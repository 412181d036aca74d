//! The messages of Sparkplug B that are read and sent, by the field numbers of the specification (Eclipse Sparkplug 3.0.0, 6.4); what a reading
//! does not need is passed over.
use prost::{Message, Oneof};

/// A payload.
#[derive(Clone, PartialEq, Message)]
pub(in crate::cli::serve) struct Payload {
    /// ms since 1970.
    #[prost(uint64, optional, tag = "1")]
    pub timestamp: Option<u64>,
    #[prost(message, repeated, tag = "2")]
    pub metrics: Vec<Metric>,
    /// Number of the message of its node, 0 to 255.
    #[prost(uint64, optional, tag = "3")]
    pub seq: Option<u64>,
}

/// A metric.
#[derive(Clone, PartialEq, Message)]
pub(in crate::cli::serve) struct Metric {
    #[prost(string, optional, tag = "1")]
    pub name: Option<String>,
    /// What stands for the name after a birth.
    #[prost(uint64, optional, tag = "2")]
    pub alias: Option<u64>,
    /// ms since 1970.
    #[prost(uint64, optional, tag = "3")]
    pub timestamp: Option<u64>,
    #[prost(uint32, optional, tag = "4")]
    pub datatype: Option<u32>,
    #[prost(bool, optional, tag = "7")]
    pub is_null: Option<bool>,
    #[prost(message, optional, tag = "9")]
    pub properties: Option<Properties>,
    #[prost(oneof = "Value", tags = "10, 11, 12, 13, 14, 15, 16, 17, 18, 19")]
    pub value: Option<Value>,
}

/// The value of a metric.
#[derive(Clone, PartialEq, Oneof)]
pub(in crate::cli::serve) enum Value {
    #[prost(uint32, tag = "10")]
    Int(u32),
    #[prost(uint64, tag = "11")]
    Long(u64),
    #[prost(float, tag = "12")]
    Float(f32),
    #[prost(double, tag = "13")]
    Double(f64),
    #[prost(bool, tag = "14")]
    Boolean(bool),
    #[prost(string, tag = "15")]
    String(String),
    #[prost(bytes, tag = "16")]
    Bytes(Vec<u8>),
    #[prost(message, tag = "17")]
    DataSet(Empty),
    #[prost(message, tag = "18")]
    Template(Empty),
    #[prost(message, tag = "19")]
    Extension(Empty),
}

/// A message whose content is passed over.
#[derive(Clone, PartialEq, Message)]
pub(in crate::cli::serve) struct Empty {}

/// Properties of a metric: keys, and a value for each.
#[derive(Clone, PartialEq, Message)]
pub(in crate::cli::serve) struct Properties {
    #[prost(string, repeated, tag = "1")]
    pub keys: Vec<String>,
    #[prost(message, repeated, tag = "2")]
    pub values: Vec<Property>,
}

/// The value of a property, of which whole numbers are read.
#[derive(Clone, PartialEq, Message)]
pub(in crate::cli::serve) struct Property {
    #[prost(uint32, optional, tag = "3")]
    pub int: Option<u32>,
    #[prost(uint64, optional, tag = "4")]
    pub long: Option<u64>,
}
