//! The description of FMI 3.0.
use super::*;

pub(super) fn write(xml: &mut Xml, unit: &Instance, about: &About<'_>) {
    let (token, tool, step) = (unit.token(), tool(), number(about.step_s));
    let attributes = [
        ("fmiVersion", "3.0"),
        ("modelName", about.name),
        ("instantiationToken", token.as_str()),
        ("description", about.description),
        ("version", env!("CARGO_PKG_VERSION")),
        ("license", env!("CARGO_PKG_LICENSE")),
        ("generationTool", tool.as_str()),
        ("variableNamingConvention", "flat"),
    ];
    let variables = unit.variables();
    xml.with("fmiModelDescription", &attributes, |xml| {
        let abilities = [
            ("modelIdentifier", MODEL_IDENTIFIER),
            ("canHandleVariableCommunicationStepSize", "true"),
            ("canGetAndSetFMUState", "true"),
            ("canSerializeFMUState", "true"),
        ];
        xml.empty("CoSimulation", &abilities);
        units(xml, variables);
        let enumerations = enumerations(variables);
        if !enumerations.is_empty() {
            xml.with("TypeDefinitions", &[], |xml| {
                for of in &enumerations {
                    let attributes = [("name", of.name), ("description", of.description)];
                    xml.with("EnumerationType", &attributes, |xml| items(xml, of));
                }
            });
        }
        xml.empty("DefaultExperiment", &[("startTime", "0"), ("stepSize", &step)]);
        xml.with("ModelVariables", &[], |xml| {
            variables.iter().enumerate().for_each(|(place, of)| variable(xml, place, of));
        });
        xml.with("ModelStructure", &[], |xml| {
            for element in ["Output", "InitialUnknown"] {
                for place in outputs(variables) {
                    xml.empty(element, &[("valueReference", &place.to_string())]);
                }
            }
        });
    });
}

fn variable(xml: &mut Xml, place: usize, of: &Variable) {
    let mut attributes = vec![
        ("name", of.name.clone()),
        ("valueReference", place.to_string()),
        ("description", of.description.clone()),
        ("causality", causality(of.causality).to_owned()),
        ("variability", variability(of).to_owned()),
    ];
    let element = match of.kind {
        Type::Real(unit) => {
            attributes.extend(of_real(of, unit));
            "Float64"
        }
        Type::Integer => "Int32",
        Type::Enumeration(of) => {
            attributes.push(("declaredType", of.name.to_owned()));
            "Enumeration"
        }
    };
    xml.empty(element, &borrowed(&attributes));
}
