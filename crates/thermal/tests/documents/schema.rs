//! The JSON schemas admit what the reader admits.
use cylwatch_thermal::{scenario, vessel};
use serde_json::Value;

/// Follows `$ref`.
fn resolved<'s>(schema: &'s Value, root: &'s Value) -> &'s Value {
    match schema.get("$ref").and_then(Value::as_str) {
        Some(reference) => root.pointer(reference.trim_start_matches('#')).unwrap(),
        None => schema,
    }
}

/// The schema of a key in an object schema: a property, or a pattern `^base_(unit|unit)$`.
fn of_key<'s>(object: &'s Value, key: &str) -> Option<&'s Value> {
    if let Some(found) = object.get("properties").and_then(|properties| properties.get(key)) {
        return Some(found);
    }
    let patterns = object.get("patternProperties")?.as_object()?;
    let matches = |pattern: &str| {
        let (base, units) = pattern.trim_start_matches('^').trim_end_matches(")$").split_once('(').unwrap();
        units.split('|').any(|unit| key == format!("{base}{unit}"))
    };
    patterns.iter().find(|(pattern, _)| matches(pattern)).map(|(_, schema)| schema)
}

fn assert_admits(schema: &Value, root: &Value, document: &toml::Value, path: &str) {
    let schema = resolved(schema, root);
    match document {
        toml::Value::Table(table) => {
            assert_eq!(schema.get("additionalProperties"), Some(&Value::Bool(false)), "{path}");
            for (key, value) in table {
                let inner =
                    of_key(schema, key).unwrap_or_else(|| panic!("{path}.{key} is not in the schema"));
                assert!(inner.get("$ref").is_some() || inner.get("description").is_some(), "{path}.{key}");
                assert_admits(inner, root, value, &format!("{path}.{key}"));
            }
        }
        toml::Value::Array(list) => {
            for value in list {
                assert_admits(&schema["items"], root, value, path);
            }
        }
        _ => {}
    }
}

#[test]
fn schemas_admit_every_built_in_document() {
    let (vessel, scenario) = (vessel::schema(), scenario::schema());
    for name in vessel::presets::FILES.names() {
        let document = vessel::presets::FILES.text(name).unwrap().parse::<toml::Table>().unwrap();
        assert_admits(&vessel, &vessel, &toml::Value::Table(document), name);
    }
    for name in scenario::presets::FILES.names() {
        let document = scenario::presets::FILES.text(name).unwrap().parse::<toml::Table>().unwrap();
        assert_admits(&scenario, &scenario, &toml::Value::Table(document), name);
    }
}

#[test]
fn a_quantity_takes_every_unit_of_its_dimension_and_no_other() {
    let schema = vessel::schema();
    let layer = &schema["$defs"]["LayerSpec"];
    for key in ["thickness_m", "thickness_mm", "thickness_cm"] {
        assert!(of_key(layer, key).is_some(), "{key}");
    }
    assert!(of_key(layer, "thickness_bar").is_none() && of_key(layer, "thickness").is_none());
    assert_eq!(layer["required"], serde_json::json!(["material"]));
    assert_eq!(layer["allOf"][0]["oneOf"].as_array().unwrap().len(), 3);
}

#[test]
fn schemas_know_no_null_and_no_default_in_si() {
    for schema in [vessel::schema(), scenario::schema()] {
        let text = schema.to_string();
        assert!(!text.contains("null") && !text.contains("\"format\":\"double\""), "{text}");
        assert_eq!(schema["additionalProperties"], Value::Bool(false));
    }
}
