//! `cylwatch schema` of the gateway: true of every message that the tests hear, and of the configurations that it takes.
use super::*;
use serde_json::Value;
use std::sync::LazyLock;

static SCHEMAS: LazyLock<Value> = LazyLock::new(|| {
    let folder = tempdir().unwrap();
    serde_json::from_str(&run(folder.path(), &["schema"]).stdout).unwrap()
});

/// Keywords that say nothing of a value.
const WORDS: [&str; 7] = ["$schema", "title", "description", "format", "$defs", "default", "deprecated"];

/// What a value breaks of a schema; a keyword that is not known here is a fault of the test.
fn fault(schema: &Value, value: &Value, root: &Value) -> Option<String> {
    let Value::Object(keywords) = schema else {
        return (schema == &Value::Bool(false)).then(|| format!("{value} may not be"));
    };
    keywords.iter().find_map(|(keyword, says)| match (keyword.as_str(), value) {
        ("$ref", _) => fault(root.pointer(&says.as_str().unwrap()[1..]).unwrap(), value, root),
        ("type", _) => {
            let names: Vec<&Value> = says.as_array().map_or(vec![says], |names| names.iter().collect());
            let is = |name: &&Value| match name.as_str().unwrap() {
                "object" => value.is_object(),
                "array" => value.is_array(),
                "string" => value.is_string(),
                "boolean" => value.is_boolean(),
                "null" => value.is_null(),
                "number" => value.is_number(),
                "integer" => value.is_i64() || value.is_u64(),
                other => panic!("type {other}"),
            };
            (!names.iter().any(is)).then(|| format!("{value} is not {says}"))
        }
        ("enum", _) => {
            (!says.as_array().unwrap().contains(value)).then(|| format!("{value} is not one of {says}"))
        }
        ("const", _) => (says != value).then(|| format!("{value} is not {says}")),
        ("required", Value::Object(object)) => {
            let missing =
                says.as_array().unwrap().iter().find(|name| !object.contains_key(name.as_str().unwrap()));
            missing.map(|name| format!("{name} is missing"))
        }
        ("properties" | "patternProperties", Value::Object(object)) => {
            object.iter().find_map(|(name, inner)| {
                fault(&named(keywords, keyword, name)?, inner, root).map(|fault| format!("{name}: {fault}"))
            })
        }
        ("additionalProperties", Value::Object(object)) => object.iter().find_map(|(name, inner)| {
            let is_known =
                ["properties", "patternProperties"].iter().any(|of| named(keywords, of, name).is_some());
            (!is_known).then(|| fault(says, inner, root).map(|fault| format!("{name}: {fault}"))).flatten()
        }),
        ("items", Value::Array(list)) => list.iter().find_map(|inner| fault(says, inner, root)),
        ("minItems", Value::Array(list)) => {
            (list.len() < says.as_u64().unwrap() as usize).then(|| format!("{value} is short"))
        }
        ("maxItems", Value::Array(list)) => {
            (list.len() > says.as_u64().unwrap() as usize).then(|| format!("{value} is long"))
        }
        ("minimum", Value::Number(number)) => {
            (number.as_f64() < says.as_f64()).then(|| format!("{value} is below {says}"))
        }
        ("maximum", Value::Number(number)) => {
            (number.as_f64() > says.as_f64()).then(|| format!("{value} is above {says}"))
        }
        ("allOf", _) => says.as_array().unwrap().iter().find_map(|one| fault(one, value, root)),
        ("anyOf" | "oneOf", _) => {
            let fit = says.as_array().unwrap().iter().filter(|one| fault(one, value, root).is_none()).count();
            let is_fine = fit == 1 || (keyword == "anyOf" && fit > 1);
            (!is_fine).then(|| format!("{value} fits {fit} of {says}"))
        }
        (
            "required"
            | "properties"
            | "patternProperties"
            | "additionalProperties"
            | "items"
            | "minItems"
            | "maxItems"
            | "minimum"
            | "maximum",
            _,
        ) => None,
        (other, _) => {
            assert!(WORDS.contains(&other), "the test does not know {other}");
            None
        }
    })
}

/// The schema of a property. A pattern is `^base_(unit|unit)$`.
fn named(schema: &serde_json::Map<String, Value>, of: &str, name: &str) -> Option<Value> {
    let known = schema.get(of)?.as_object()?;
    let fits = |pattern: &str| match pattern.strip_prefix('^').and_then(|rest| rest.strip_suffix(")$")) {
        Some(rest) => {
            let (base, units) = rest.split_once("_(").unwrap();
            let unit = name.strip_prefix(base).and_then(|rest| rest.strip_prefix('_'));
            unit.is_some_and(|unit| units.split('|').any(|known| known == unit))
        }
        None => pattern == name,
    };
    known.iter().find(|(pattern, _)| fits(pattern)).map(|(_, schema)| schema.clone())
}

fn broken(what: &str, value: &Value) -> Option<String> {
    let schema = &SCHEMAS[what];
    assert!(schema.is_object(), "{what}");
    fault(schema, value, schema)
}

/// Holds all that was heard against the schemas.
pub(super) fn assert_true_of(heard: &Heard) {
    for (topic, payload, _) in heard.lock().unwrap().iter().filter(|(_, payload, _)| !payload.is_empty()) {
        let what = topic.split('/').nth(2).unwrap();
        if what != "acknowledge" {
            let message = serde_json::from_str(payload).unwrap();
            assert_eq!(broken(what, &message), None, "{topic}: {payload}");
        }
    }
}

fn configured(text: &str) -> Value {
    serde_json::to_value(toml::from_str::<toml::Table>(text).unwrap()).unwrap()
}

#[test]
fn the_configurations_that_the_gateway_takes_fit_their_schema_and_others_do_not() {
    let right = configuration(1883, "5");
    assert_eq!(broken("gateway", &configured(&right)), None);
    for file in ["packaging/gateway.toml", "book/gateway/gateway.toml"] {
        let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(file)).unwrap();
        assert_eq!(broken("gateway", &configured(&text)), None, "{file}");
        let folder = tempdir().unwrap();
        std::fs::write(folder.path().join("gateway.toml"), text).unwrap();
        assert_eq!(run(folder.path(), &["serve", "gateway.toml", "--check"]).code, Some(0), "{file}");
    }
    for (from, to) in [
        ("client_id", "clint_id"),
        ("\"5\"", "\"4\""),
        ("client_id =", "password = \"sesame\"\nclient_id ="),
        ("client_id =", "keep_alive_bar = 30\nclient_id ="),
        ("fill_pressure_bar = 200", "fill_pressure_l = 200"),
        ("fill_pressure_bar = 200", "fill_pressure_bar = \"200\""),
        ("settled = true", "settled = 1"),
        ("most = 1", "most = 1.5"),
    ] {
        let wrong = right.replacen(from, to, 1);
        assert_ne!(wrong, right, "{from}");
        assert!(broken("gateway", &configured(&wrong)).is_some(), "{to}");
    }
    let other_units = right.replace("fill_pressure_bar = 200", "fill_pressure_psi = 2900");
    assert_eq!(broken("gateway", &configured(&other_units)), None);
}

#[test]
fn a_message_with_a_key_too_many_or_too_few_breaks_its_schema() {
    let line = r#"{"id":"a","event":"gap","time_s":1,"gap_s":2}"#;
    assert_eq!(broken("event", &serde_json::from_str(line).unwrap()), None);
    for wrong in [
        line.replace("gap_s", "gap_h"),
        line.replace("\"id\":\"a\",", ""),
        line.replace("\"gap\"", "\"pause\""),
        line.replace("1", "null"),
    ] {
        assert!(broken("event", &serde_json::from_str(&wrong).unwrap()).is_some(), "{wrong}");
    }
}
