//! The description of FMI 2.0.
use super::*;

/// Variables at the front that are left out: FMI 2.0 needs no variable for the time, and FMI Library calls one without start an error.
const TIME: usize = 1;

pub(super) fn write(xml: &mut Xml, unit: &Instance, about: &About<'_>) {
    let (token, tool, step) = (unit.token(), tool(), number(about.step_s));
    let attributes = [
        ("fmiVersion", "2.0"),
        ("modelName", about.name),
        ("guid", token.as_str()),
        ("description", about.description),
        ("version", env!("CARGO_PKG_VERSION")),
        ("license", env!("CARGO_PKG_LICENSE")),
        ("generationTool", tool.as_str()),
        ("variableNamingConvention", "flat"),
        ("numberOfEventIndicators", "0"),
    ];
    let variables = unit.variables();
    xml.with("fmiModelDescription", &attributes, |xml| {
        let abilities = [
            ("modelIdentifier", MODEL_IDENTIFIER),
            ("canHandleVariableCommunicationStepSize", "true"),
            ("canGetAndSetFMUstate", "true"),
            ("canSerializeFMUstate", "true"),
        ];
        xml.empty("CoSimulation", &abilities);
        units(xml, variables);
        let enumerations = enumerations(variables);
        if !enumerations.is_empty() {
            xml.with("TypeDefinitions", &[], |xml| enumerations.iter().for_each(|of| simple_type(xml, of)));
        }
        xml.empty("DefaultExperiment", &[("startTime", "0"), ("stepSize", &step)]);
        xml.with("ModelVariables", &[], |xml| {
            variables.iter().enumerate().skip(TIME).for_each(|(place, of)| variable(xml, place, of));
        });
        xml.with("ModelStructure", &[], |xml| {
            for element in ["Outputs", "InitialUnknowns"] {
                xml.with(element, &[], |xml| {
                    // Numbered from 1, which the variable behind the time is.
                    outputs(variables)
                        .for_each(|place| xml.empty("Unknown", &[("index", &place.to_string())]));
                });
            }
        });
    });
}

fn simple_type(xml: &mut Xml, of: &Enumeration) {
    xml.with("SimpleType", &[("name", of.name), ("description", of.description)], |xml| {
        xml.with("Enumeration", &[], |xml| items(xml, of));
    });
}

fn variable(xml: &mut Xml, place: usize, of: &Variable) {
    let reference = place.to_string();
    let attributes = [
        ("name", of.name.as_str()),
        ("valueReference", reference.as_str()),
        ("description", of.description.as_str()),
        ("causality", causality(of.causality)),
        ("variability", variability(of)),
    ];
    xml.with("ScalarVariable", &attributes, |xml| match of.kind {
        Type::Real(unit) => xml.empty("Real", &borrowed(&of_real(of, unit))),
        Type::Integer => xml.empty("Integer", &[]),
        Type::Enumeration(of) => xml.empty("Enumeration", &[("declaredType", of.name)]),
    });
}
