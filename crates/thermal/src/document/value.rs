//! A serde `Deserializer` over toml's tree with spans that converts units on the way.
use std::vec;

use serde::de::{self, DeserializeSeed, Deserializer, IntoDeserializer, Visitor};
use serde::forward_to_deserialize_any;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::keys::{example, match_key};
use super::read_error::ReadError;
use super::suggestion;
use super::{Context, Place, field_name};
use crate::problem::{Problem, with_table, without_indices};
use crate::units::Unit;

/// Reader of one value.
pub(super) struct ValueReader<'a, 't> {
    value: &'a Spanned<DeValue<'t>>,
    context: &'a Context<'t>,
    /// Path by field names, e.g. `layer[1].thickness_m`.
    path: String,
    /// Key as written.
    key: &'a str,
    /// Line of the key, or of the element of a list.
    line: usize,
    unit: Option<&'static Unit>,
}

impl<'a, 't> ValueReader<'a, 't> {
    pub(super) fn root(value: &'a Spanned<DeValue<'t>>, context: &'a Context<'t>) -> Self {
        Self { value, context, path: String::new(), key: "", line: 1, unit: None }
    }

    fn noted(self) -> Self {
        let is_table = self.value.get_ref().is_table();
        let text = if is_table { String::new() } else { self.context.written(self.value.span()) };
        let place = Place { line: self.line, key: self.key.to_owned(), text };
        self.context.places.borrow_mut().insert(self.path.clone(), place);
        self
    }

    fn named(&self) -> String {
        with_table(&self.path, self.key)
    }

    fn placed(&self, problem: Problem) -> ReadError {
        ReadError::Placed(Box::new((self.line, problem)))
    }

    fn text(&self) -> String {
        self.context.written(self.value.span())
    }

    fn wrong_type(&self, expected: &str) -> ReadError {
        let (key, text) = (self.named(), self.text());
        let expected = match self.value.get_ref() {
            DeValue::Table(_) if expected == "a list" => {
                format!("a list: write [[{}]], in two brackets, for each", key.replace(' ', "."))
            }
            _ => expected.to_owned(),
        };
        self.placed(Problem::WrongType { key, text, expected })
    }

    /// Gives an error of a visitor its line and names.
    fn place(&self, error: ReadError) -> ReadError {
        match error {
            ReadError::Type { expected } => self.wrong_type(&expected),
            ReadError::Missing { field } => {
                let key = match without_indices(&self.path) {
                    table if table.is_empty() => example(field),
                    table => format!("{table} {}", example(field)),
                };
                self.placed(Problem::Missing { key, remedy: "add it".to_owned() })
            }
            ReadError::Choice { known } => {
                let text = self.text();
                let nearest = suggestion(text.trim_matches('"'), known.iter().copied());
                self.placed(Problem::UnknownChoice {
                    key: self.named(),
                    text,
                    nearest,
                    known: known.join(", "),
                })
            }
            ReadError::Other(message) => {
                self.placed(Problem::WrongType { key: self.named(), text: self.text(), expected: message })
            }
            placed @ ReadError::Placed(_) => placed,
        }
    }

    /// The number, in SI if the key has a unit.
    fn number(&self) -> Result<f64, ReadError> {
        let raw = match self.value.get_ref() {
            DeValue::Integer(integer) => i128::from_str_radix(integer.as_str(), integer.radix())
                .map_or(f64::INFINITY, |integer| integer as f64),
            DeValue::Float(float) => float.as_str().parse().unwrap_or(f64::NAN),
            _ => return Err(self.wrong_type("a number")),
        };
        let number = self.unit.map_or(raw, |unit| unit.to_si(raw));
        if number.is_finite() {
            return Ok(number);
        }
        Err(self.placed(Problem::NotFinite { key: self.named(), text: self.text() }))
    }

    /// The entries of a table with the fields they belong to, in the order of the file.
    fn entries(
        &self,
        table: &'a DeTable<'t>,
        fields: &'static [&'static str],
    ) -> Result<Vec<(&'static str, Self)>, ReadError> {
        let mut written: Vec<_> = table.iter().collect();
        written.sort_by_key(|(key, _)| key.span().start);
        let mut entries: Vec<(&'static str, Self)> = Vec::with_capacity(written.len());
        for (key, value) in written {
            let line = self.context.line(key.span().start);
            let key = key.get_ref().as_ref();
            let inside = |name: &str| match self.path.as_str() {
                "" => name.to_owned(),
                table => format!("{table}.{name}"),
            };
            let named = with_table(&inside(key), key);
            let (field, unit) = match_key(key, fields)
                .map_err(|problem| ReadError::Placed(Box::new((line, renamed(problem, named.clone())))))?;
            if let Some((_, first)) = entries.iter().find(|(other, _)| *other == field) {
                let (first, first_line) = (first.key.to_owned(), first.line);
                let problem = Problem::Twice { key: named, first, first_line };
                return Err(ReadError::Placed(Box::new((line, problem))));
            }
            let reader = Self { value, context: self.context, path: inside(field), key, line, unit };
            entries.push((field, reader.noted()));
        }
        Ok(entries)
    }
}

/// The problem with the key's table before the key.
fn renamed(mut problem: Problem, name: String) -> Problem {
    match &mut problem {
        Problem::UnknownKey { key, .. } | Problem::NoUnit { key, .. } | Problem::WrongUnit { key, .. } => {
            *key = name;
        }
        _ => {}
    }
    problem
}

impl<'de> Deserializer<'de> for ValueReader<'_, '_> {
    type Error = ReadError;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        let read = match self.value.get_ref() {
            DeValue::String(text) => visitor.visit_str(text),
            DeValue::Boolean(value) => visitor.visit_bool(*value),
            DeValue::Integer(integer) if self.unit.is_none() => {
                match i64::from_str_radix(integer.as_str(), integer.radix()) {
                    Ok(integer) => visitor.visit_i64(integer),
                    Err(_) => return Err(self.wrong_type("a smaller number")),
                }
            }
            DeValue::Integer(_) | DeValue::Float(_) => visitor.visit_f64(self.number()?),
            DeValue::Datetime(_) => return Err(self.wrong_type("another type than a date")),
            DeValue::Array(array) => {
                let elements: Vec<Self> = array
                    .iter()
                    .enumerate()
                    .map(|(i, value)| {
                        let line = self.context.line(value.span().start);
                        let path = format!("{}[{i}]", self.path);
                        Self { value, path, line, ..self }.noted()
                    })
                    .collect();
                visitor.visit_seq(Elements(elements.into_iter()))
            }
            DeValue::Table(_) => visitor.visit_map(Entries { rest: Vec::new().into_iter(), value: None }),
        };
        read.map_err(|error| self.place(error))
    }

    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        visitor.visit_f64::<ReadError>(self.number()?).map_err(|error| self.place(error))
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        visitor.visit_some(self)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, ReadError> {
        let DeValue::String(text) = self.value.get_ref() else {
            return Err(self.wrong_type("text in quotes"));
        };
        let choice: de::value::StrDeserializer<'_, ReadError> = text.as_ref().into_deserializer();
        visitor.visit_enum(choice).map_err(|error| self.place(error))
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, ReadError> {
        let DeValue::Table(table) = self.value.get_ref() else { return Err(self.wrong_type("a table")) };
        let rest = self.entries(table, fields)?.into_iter();
        visitor.visit_map(Entries { rest, value: None }).map_err(|error| self.place(error))
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 char str string bytes byte_buf unit unit_struct
        newtype_struct seq tuple tuple_struct map identifier ignored_any
    }
}

/// The entries of a table.
struct Entries<'a, 't> {
    rest: vec::IntoIter<(&'static str, ValueReader<'a, 't>)>,
    value: Option<ValueReader<'a, 't>>,
}

impl<'de> de::MapAccess<'de> for Entries<'_, '_> {
    type Error = ReadError;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, ReadError> {
        let Some((field, value)) = self.rest.next() else { return Ok(None) };
        self.value = Some(value);
        seed.deserialize(field_name(field)).map(Some)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, ReadError> {
        match self.value.take() {
            Some(value) => seed.deserialize(value),
            None => Err(de::Error::custom("a value was asked for before its key")),
        }
    }
}

/// The elements of a list.
struct Elements<'a, 't>(vec::IntoIter<ValueReader<'a, 't>>);

impl<'de> de::SeqAccess<'de> for Elements<'_, '_> {
    type Error = ReadError;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, ReadError> {
        self.0.next().map(|value| seed.deserialize(value)).transpose()
    }
}
