//! The paragraphs of the report.

pub(super) const LEAD: &str = "Every figure and table of H. Bücking, R. Pfaff, R. Dirksmeier, Sensor positioning and thermal model for condition \
     monitoring of pressure gas reservoirs in vehicles, from the model instead of the measurement, beside the paper\u{2019}s own numbers; then the \
     same cases with an observer and a detector. The last table says where paper and model differ, and why.";
pub(super) const SECTION_2: &str = "The paper estimates mass and heat capacities with the ideal gas. The model has the reference equation of state of \
     nitrogen (Span et al. 2000).";
pub(super) const FIGURE_1: &str = "The 20 L steel cylinder in a chamber whose air jumps from \u{2212}25 to 40 °C. Film outside (20 W/m²/K) and mounting are assumed: \
     the paper does not state them.";
pub(super) const TABLE: &str = "A first-order transfer function by output error with its start estimated, as MATLAB\u{2019}s tfest does, from a sample a minute. \
     Refitted is the same with the gain held at 1, the only one that physics allows; the comparisons below use it with a real gas.";
pub(super) const FIGURE_3: &str =
    "The models on scenarios 3 and 4, which they were not identified from, with and without a first value.";
pub(super) const FIGURE_4: &str = "The transfer function makes a gas temperature of the shoulder\u{2019}s, the slope a pressure of that; less the pressure that is read, it is \
     the error. A threshold that is exceeded for ten minutes is a leak, the slope of the error its rate.";
pub(super) const FIGURE_6: &str = "The paper steps the shoulder itself from \u{2212}10 to 35 °C. On a simulated cylinder the air steps, and the published expectation is off \
     by bars where nothing is missing.";
pub(super) const FIGURE_8: &str = "The paper subtracts a steady loss and noise of 10 mbar from its own expectation. On a simulated cylinder, detectors by threshold \
     get the lowest one at which they are silent in the same passage of a tight cylinder, and a tenth more; the monitor has its own, for one false alarm \
     in ten years.";
pub(super) const DRAWN: &str = "Cylinders with drawn films, capacities, mounting and sensor errors, gusts, and stratified gas. The observer knows the nominal \
     cylinder, reads shoulder, valve and pressure, and is zeroed on the hour before, as the refitted scheme is; the published scheme is as published. Bound: \
     what no estimator goes below in a world that is the observer\u{2019}s own model with its uncertainty; in this world, which is another one, it is what could be hoped for. \
     Of the pressure it counts the gas temperature alone: the drawn transmitters also drift by 1 to 2.4 bar over 65 K, which no one knows at first. \
     All start cold; what ten days of learning make of the observer stands in the book\u{2019}s table of measured numbers.";
pub(super) const DRAWN_LEAKS: &str = "Thresholds of the detectors without an observer: the lowest at which they are silent on as many other tight cylinders in the same \
     passage, and a tenth more: they are made for this tunnel. Before it: alarms before the leak has begun. Bound: when a filter at rest could know of it at the monitor\u{2019}s rate of false alarms, and \
     the standard deviation of its rate at the end.";
pub(super) const MEASURED: &str = "Closed forms, reference values and the balances of every run are in the tests; here is what can be seen.";
pub(super) const LIMITS: &str = "Only simulated: all that concerns the 20 L cylinder. Film coefficients and mounting are assumed, the paper\u{2019}s measured curves are not \
     published as data.";
