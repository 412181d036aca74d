//! `modelDescription.xml` of the Functional Mock-up Interface: what a unit says of itself to a master.
//!
//! # References
//! Functional Mock-up Interface 2.0.4, section 2.2 and 4.3; 3.0.1, sections 2.4 and 4.3. <https://fmi-standard.org>
mod fmi2;
mod fmi3;

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesEnd, BytesStart, Event};

use crate::variable::{Causality, DisplayUnit, Enumeration, Type, Unit, Variable};
use crate::{CosimulationError, Instance};

/// Name of the library in an archive, without its ending.
pub const MODEL_IDENTIFIER: &str = "cylwatch";

/// Version of the interface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Version {
    /// 2.0.
    Two,
    /// 3.0.
    Three,
}

/// What a description says of a unit beside its variables.
#[derive(Clone, Copy, Debug)]
pub struct About<'a> {
    /// Name of the model.
    pub name: &'a str,
    /// What it is.
    pub description: &'a str,
    /// Step that is proposed, s.
    pub step_s: f64,
}

/// The description of a unit, which is a resource's instance.
///
/// # Errors
/// Memory that cannot be written to: never.
pub fn describe(unit: &Instance, about: &About<'_>, version: Version) -> Result<String, CosimulationError> {
    let mut xml = Xml::new();
    match version {
        Version::Two => fmi2::write(&mut xml, unit, about),
        Version::Three => fmi3::write(&mut xml, unit, about),
    }
    Ok(xml.finish())
}

/// Elements, indented.
struct Xml(Writer<Vec<u8>>);

type Attributes<'a> = &'a [(&'a str, &'a str)];

impl Xml {
    fn new() -> Self {
        let mut xml = Self(Writer::new_with_indent(Vec::new(), b' ', 2));
        xml.event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)));
        xml
    }

    fn event(&mut self, event: Event<'_>) {
        // Memory takes everything.
        _ = self.0.write_event(event);
    }

    /// An element without content.
    fn empty(&mut self, name: &str, attributes: Attributes<'_>) {
        self.event(Event::Empty(BytesStart::new(name).with_attributes(attributes.iter().copied())));
    }

    /// An element with content.
    fn with(&mut self, name: &str, attributes: Attributes<'_>, content: impl FnOnce(&mut Self)) {
        self.event(Event::Start(BytesStart::new(name).with_attributes(attributes.iter().copied())));
        content(self);
        self.event(Event::End(BytesEnd::new(name)));
    }

    fn finish(self) -> String {
        let mut text = String::from_utf8(self.0.into_inner()).unwrap_or_default();
        text.push('\n');
        text
    }
}

/// A number as `xs:double` has it.
fn number(value: f64) -> String {
    match value {
        value if value.is_nan() => "NaN".to_owned(),
        value if value.is_infinite() => if value > 0.0 { "INF" } else { "-INF" }.to_owned(),
        value => value.to_string(),
    }
}

const fn causality(of: Causality) -> &'static str {
    match of {
        Causality::Independent => "independent",
        Causality::Parameter => "parameter",
        Causality::Input => "input",
        Causality::Output => "output",
    }
}

/// How a variable changes.
const fn variability(of: &Variable) -> &'static str {
    match (of.causality, of.kind) {
        (Causality::Parameter, _) => "fixed",
        (_, Type::Real(_)) => "continuous",
        (_, Type::Integer | Type::Enumeration(_)) => "discrete",
    }
}

/// Units that variables have, each name once.
fn units(xml: &mut Xml, variables: &[Variable]) {
    let used = |unit: &Unit| variables.iter().any(|variable| variable.kind == Type::Real(*unit));
    let mut written = Vec::new();
    xml.with("UnitDefinitions", &[], |xml| {
        for unit in Unit::ALL.into_iter().filter(used) {
            if !written.contains(&unit.symbol()) {
                written.push(unit.symbol());
                unit_definition(xml, unit);
            }
        }
    });
}

fn unit_definition(xml: &mut Xml, unit: Unit) {
    xml.with("Unit", &[("name", unit.symbol())], |xml| {
        let exponents = unit.exponents().map(|exponent| exponent.to_string());
        let base: Vec<(&str, &str)> = ["kg", "m", "s", "K"]
            .into_iter()
            .zip(exponents.iter().map(String::as_str))
            .filter(|(_, exponent)| *exponent != "0")
            .collect();
        xml.empty("BaseUnit", &base);
        if let Some(DisplayUnit { name, factor, offset }) = unit.display() {
            let (factor, offset) = (number(factor), number(offset));
            xml.empty("DisplayUnit", &[("name", name), ("factor", &factor), ("offset", &offset)]);
        }
    });
}

/// Enumerations that variables have, each once.
fn enumerations(variables: &[Variable]) -> Vec<&'static Enumeration> {
    let mut found: Vec<&'static Enumeration> = Vec::new();
    for variable in variables {
        if let Type::Enumeration(of) = variable.kind
            && !found.contains(&of)
        {
            found.push(of);
        }
    }
    found
}

fn items(xml: &mut Xml, of: &Enumeration) {
    for (index, (name, description)) in of.items.iter().enumerate() {
        let value = (index + 1).to_string();
        xml.empty("Item", &[("name", name), ("value", &value), ("description", description)]);
    }
}

/// Attributes of what can be set, and units of a number.
fn of_real(variable: &Variable, unit: Unit) -> Vec<(&'static str, String)> {
    let mut attributes = vec![("unit", unit.symbol().to_owned())];
    // A difference of temperatures has no offset.
    if let Some(display) = unit.display() {
        attributes.push(("displayUnit", display.name.to_owned()));
    }
    if let Some((low, high)) = variable.range {
        attributes.push(("min", number(low)));
        attributes.push(("max", number(high)));
    }
    if let Some(start) = variable.start {
        attributes.push(("start", number(start)));
    }
    attributes
}

fn borrowed<'a>(attributes: &'a [(&'static str, String)]) -> Vec<(&'a str, &'a str)> {
    attributes.iter().map(|(name, value)| (*name, value.as_str())).collect()
}

fn tool() -> String {
    format!("cylwatch {}", env!("CARGO_PKG_VERSION"))
}

/// Places of outputs: value references.
fn outputs(variables: &[Variable]) -> impl Iterator<Item = usize> + '_ {
    let is_output = |(_, variable): &(usize, &Variable)| variable.causality == Causality::Output;
    variables.iter().enumerate().filter(is_output).map(|(place, _)| place)
}
