//! JSON schemas of documents: the derived schema of a specification, opened to every unit of each quantity.
use schemars::{JsonSchema, schema_for};
use serde_json::{Map, Value, json};

use crate::units;

/// JSON schema of documents that are read into `T`.
///
/// A field `thickness_m` becomes the pattern `^thickness_(mm|m|cm)$`; any other key is refused.
pub fn of<T: JsonSchema>(title: &str) -> Value {
    let mut schema = schema_for!(T).to_value();
    open_units(&mut schema);
    if let Some(root) = schema.as_object_mut() {
        root.insert("title".to_owned(), json!(title));
    }
    schema
}

/// Rewrites every object schema in `value`, depth first.
fn open_units(value: &mut Value) {
    match value {
        Value::Array(list) => list.iter_mut().for_each(open_units),
        Value::Object(object) => {
            object.values_mut().for_each(open_units);
            without_null(object);
            if object.get("properties").is_some_and(Value::is_object) {
                open_object(object);
            }
        }
        _ => {}
    }
}

/// TOML has no null: an optional key is left out instead.
fn without_null(schema: &mut Map<String, Value>) {
    if let Some(Value::Array(types)) = schema.get_mut("type") {
        types.retain(|name| name != "null");
        if let [only] = &types[..] {
            let only = only.clone();
            schema.insert("type".to_owned(), only);
        }
    }
    if let Some(Value::Array(mut choices)) = schema.remove("anyOf") {
        choices.retain(|choice| choice != &json!({ "type": "null" }));
        match choices.pop() {
            Some(Value::Object(only)) if choices.is_empty() => schema.extend(only),
            Some(last) => {
                choices.push(last);
                schema.insert("anyOf".to_owned(), Value::Array(choices));
            }
            None => {}
        }
    }
    // A derived default of a table spells out nulls and SI fields.
    if schema.get("default").is_some_and(|default| default.is_object() || default.is_null()) {
        schema.remove("default");
    }
    if schema.get("format") == Some(&json!("double")) {
        schema.remove("format");
    }
}

fn open_object(object: &mut Map<String, Value>) {
    let Some(Value::Object(properties)) = object.remove("properties") else { return };
    let mut plain = Map::new();
    let mut patterns = Map::new();
    for (name, mut property) in properties {
        match units::split(&name) {
            None => {
                plain.insert(name, property);
            }
            Some((base, unit)) => {
                if let Some(property) = property.as_object_mut() {
                    // The derived default is in SI, whatever unit the document uses.
                    property.remove("default");
                }
                patterns.insert(format!("^{base}_({})$", suffixes(unit.dimension).join("|")), property);
            }
        }
    }
    let required = match object.remove("required") {
        Some(Value::Array(names)) => names,
        _ => Vec::new(),
    };
    let (quantities, names): (Vec<Value>, Vec<Value>) =
        required.into_iter().partition(|name| name.as_str().is_some_and(|name| units::split(name).is_some()));
    let one_unit_each: Vec<Value> =
        quantities.iter().filter_map(Value::as_str).filter_map(any_unit).collect();
    object.insert("properties".to_owned(), Value::Object(plain));
    if !patterns.is_empty() {
        object.insert("patternProperties".to_owned(), Value::Object(patterns));
    }
    if !names.is_empty() {
        object.insert("required".to_owned(), Value::Array(names));
    }
    if !one_unit_each.is_empty() {
        object.insert("allOf".to_owned(), Value::Array(one_unit_each));
    }
    object.insert("additionalProperties".to_owned(), json!(false));
}

fn suffixes(dimension: units::Dimension) -> Vec<&'static str> {
    units::units_of(dimension).map(|unit| unit.suffix).collect()
}

/// Exactly one unit of the quantity has to be there.
fn any_unit(name: &str) -> Option<Value> {
    let (base, unit) = units::split(name)?;
    let keys: Vec<Value> = suffixes(unit.dimension)
        .iter()
        .map(|suffix| json!({ "required": [format!("{base}_{suffix}")] }))
        .collect();
    Some(json!({ "oneOf": keys }))
}
