//! The paper's schemes (figures 4, 5 and 7) as graphs of the program's own stages: what is drawn is what runs.
//!
//! A [`Block`] is a stage of [`crate::evaluation::baseline`], a source or a sum, and names the blocks that it takes its inputs from. One
//! pass in the order of the blocks is one sample. Temperatures are in K, pressures in Pa.
//!
//! | figure | what it is |
//! |---|---|
//! | 4 | shoulder, transfer function, gas temperature, pressure law, expected pressure |
//! | 5 | the same, less the pressure that is read: the error, held for 10 min against a threshold, and its slope |
//! | 7 | the same with a simulated actual pressure: the expected one with noise of 10 mbar, less what a constant flow takes |
use super::methods::{FULL, LIMIT_PA};
use super::passage::{ENTRY_S, ONSET_S};
use crate::evaluation::baseline::{Expectation, GasTemperature, HOLD_S, Sustained, Trend};
use crate::report::figure::{Arrow, Diagram, Form, Node};
use crate::thermal::units::HOUR_S;
use crate::thermal::units::ZERO_CELSIUS_K;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

const BAR: f64 = 1e5;
/// Interval of the samples, s.
pub(crate) const SAMPLE_S: f64 = 10.0;
/// Duration of figures 6 and 8, s.
const DURATION_S: f64 = 14_400.0;
/// Noise of the pressure, Pa: 10 mbar.
const NOISE_PA: f64 = 1e3;
/// Loss, bar/h; the paper does not state it.
pub(crate) const LOSS_BAR_H: f64 = 3.0;
/// Threshold of the error, bar: ten times the noise; the paper states none.
pub(crate) const THRESHOLD_BAR: f64 = 0.1;
/// Shoulder before and in the tunnel, °C.
const SHOULDER_DEGC: (f64, f64) = (-10.0, 35.0);

/// What a block does.
#[derive(Clone, Debug)]
pub(crate) enum Stage {
    /// A reading that comes from outside, by its number.
    Reading(usize),
    /// Shoulder to gas.
    GasTemperature(GasTemperature),
    /// Gas temperature to expected pressure.
    Expectation(Expectation),
    /// Noise of the pressure.
    Noise(Box<ChaCha8Rng>),
    /// What a constant flow has taken since its onset.
    Loss {
        /// Rate, Pa/s.
        rate_pa_s: f64,
        /// Onset, s.
        from_s: f64,
    },
    /// Sum of the inputs with these signs.
    Sum(&'static [f64]),
    /// The smallest of the last ten minutes.
    Sustained(Sustained),
    /// Whether it is above the threshold, 1 or 0.
    Threshold(f64),
    /// Slope, 1/s.
    Slope(Trend),
}

/// A block of a scheme.
#[derive(Clone, Debug)]
pub(crate) struct Block {
    /// What it is, as drawn.
    pub words: &'static str,
    /// What comes out, as drawn.
    pub signal: &'static str,
    /// Where it is drawn: column and row.
    at: (f64, f64),
    stage: Stage,
    inputs: Vec<usize>,
}

impl Block {
    fn step(&mut self, time_s: f64, readings: &[f64], values: &[f64]) -> f64 {
        let input = |k: usize| self.inputs.get(k).map_or(f64::NAN, |&from| values[from]);
        match &mut self.stage {
            Stage::Reading(number) => readings.get(*number).copied().unwrap_or(f64::NAN),
            Stage::GasTemperature(gas) => gas.step(time_s, input(0)).unwrap_or(f64::NAN),
            Stage::Expectation(law) => law.pressure_pa(Some(input(0))).unwrap_or(f64::NAN),
            Stage::Noise(noise) => NOISE_PA * noise.sample::<f64, _>(StandardNormal),
            Stage::Loss { rate_pa_s, from_s } => *rate_pa_s * (time_s - *from_s).max(0.0),
            Stage::Sum(signs) => signs.iter().enumerate().map(|(k, sign)| sign * input(k)).sum(),
            Stage::Sustained(held) => held.update(time_s, input(0)).unwrap_or(f64::NEG_INFINITY),
            Stage::Threshold(threshold_pa) => f64::from(u8::from(input(0) >= *threshold_pa)),
            Stage::Slope(trend) => {
                trend.update(time_s, input(0));
                trend.slope().unwrap_or(f64::NAN)
            }
        }
    }
}

/// A scheme: its blocks in the order in which they run.
#[derive(Clone, Debug)]
pub(crate) struct Scheme {
    /// Title.
    pub title: &'static str,
    blocks: Vec<Block>,
}

impl Scheme {
    /// Figure 4: from the shoulder to the expected pressure.
    pub(crate) fn figure_4() -> Self {
        let mut scheme =
            Self { title: "Figure 4: from the shoulder to the expected pressure", blocks: Vec::new() };
        scheme.expected();
        scheme.blocks.iter_mut().for_each(|block| block.at.1 = 0.0);
        scheme
    }

    /// Figure 5: the error between expected and actual pressure, and what is made of it.
    pub(crate) fn figure_5() -> Self {
        let mut scheme = Self { title: "Figure 5: the error, a threshold, a rate", blocks: Vec::new() };
        let expected = scheme.expected();
        let actual = scheme.add("pressure sensor", "p_a", (2.0, 2.1), Stage::Reading(1), &[]);
        scheme.judged(expected, actual);
        scheme
    }

    /// Figure 7: the simulated leak.
    pub(crate) fn figure_7(seed: u64) -> Self {
        let mut scheme = Self { title: "Figure 7: the same with a simulated leak", blocks: Vec::new() };
        let expected = scheme.expected();
        let noise = Stage::Noise(Box::new(ChaCha8Rng::seed_from_u64(seed)));
        let noise = scheme.add("noise\n10 mbar", "", (1.0, 2.1), noise, &[]);
        let loss = Stage::Loss { rate_pa_s: LOSS_BAR_H * BAR / HOUR_S, from_s: ONSET_S };
        let loss = scheme.add("constant flow\nfrom t2", "Δp_V", (1.0, 3.1), loss, &[]);
        let sum = Stage::Sum(&[1.0, 1.0, -1.0]);
        let actual = scheme.add("", "p_a", (2.0, 2.1), sum, &[expected, noise, loss]);
        scheme.judged(expected, actual);
        scheme
    }

    fn add(
        &mut self,
        words: &'static str,
        signal: &'static str,
        at: (f64, f64),
        stage: Stage,
        inputs: &[usize],
    ) -> usize {
        self.blocks.push(Block { words, signal, at, stage, inputs: inputs.to_vec() });
        self.blocks.len() - 1
    }

    /// Shoulder to expected pressure.
    fn expected(&mut self) -> usize {
        let shoulder = self.add("thermometer\non the shoulder", "T_S", (0.0, 1.0), Stage::Reading(0), &[]);
        let gas = Stage::GasTemperature(GasTemperature::PUBLISHED);
        let gas =
            self.add("transfer function\n0.003121/\n(s + 0.003021)", "T_N2", (1.0, 1.0), gas, &[shoulder]);
        let law = Stage::Expectation(Expectation::Published(FULL));
        self.add("200 bar + 0.8457\nbar/°C (T \u{2212} 15 °C)", "p_t", (2.0, 1.0), law, &[gas])
    }

    /// The error and what is made of it.
    fn judged(&mut self, expected: usize, actual: usize) {
        let error = self.add("", "e", (3.0, 1.0), Stage::Sum(&[1.0, -1.0]), &[expected, actual]);
        let held = Stage::Sustained(Sustained::new(HOLD_S));
        let held = self.add("smallest of\nthe last 10 min", "", (4.0, 1.0), held, &[error]);
        let alarm = Stage::Threshold(THRESHOLD_BAR * BAR);
        self.add("above threshold:\nleak", "", (4.0, 2.1), alarm, &[held]);
        let slope = Stage::Slope(Trend::default());
        self.add("slope:\nloss in bar/h", "", (3.0, 0.0), slope, &[error]);
    }

    /// One sample: what comes out of every block, K, Pa, Pa/s, s or 1 and 0.
    pub(crate) fn step(&mut self, time_s: f64, readings: &[f64]) -> Vec<f64> {
        let mut values = Vec::with_capacity(self.blocks.len());
        for block in &mut self.blocks {
            let value = block.step(time_s, readings, &values);
            values.push(value);
        }
        values
    }

    /// The scheme as it runs.
    pub(crate) fn diagram(&self) -> Diagram {
        let node = |block: &Block| Node {
            words: block.words.into(),
            at: block.at,
            form: match block.stage {
                Stage::Sum(_) => Form::Sum,
                Stage::Reading(_) => Form::Source,
                _ => Form::Box,
            },
        };
        // A signal is named where it is used first.
        let is_first =
            |to: usize, from: usize| !self.blocks[..to].iter().any(|block| block.inputs.contains(&from));
        let arrows = self.blocks.iter().enumerate().flat_map(|(to, block)| {
            block.inputs.iter().enumerate().map(move |(k, &from)| Arrow {
                from,
                to,
                signal: if is_first(to, from) { self.blocks[from].signal.into() } else { String::new() },
                sign: match &block.stage {
                    Stage::Sum(signs) => Some(signs[k] > 0.0),
                    _ => None,
                },
            })
        });
        Diagram {
            title: self.title.into(),
            nodes: self.blocks.iter().map(node).collect(),
            arrows: arrows.collect(),
        }
    }

    fn index(&self, stage: impl Fn(&Stage) -> bool) -> usize {
        self.blocks.iter().position(|block| stage(&block.stage)).unwrap_or(0)
    }
}

/// Figures 6 and 8 as the paper has them: the scheme of figure 7 over the step of the shoulder.
#[derive(Clone, Debug, Default)]
pub(crate) struct SchemeRun {
    /// Time, s.
    pub time_s: Vec<f64>,
    /// Shoulder, °C.
    pub shoulder_degc: Vec<f64>,
    /// Gas, °C.
    pub gas_degc: Vec<f64>,
    /// Expected pressure, bar.
    pub expected_bar: Vec<f64>,
    /// Actual pressure, bar.
    pub actual_bar: Vec<f64>,
    /// Error, bar.
    pub error_bar: Vec<f64>,
    /// Loss at the end, bar/h.
    pub rate_bar_h: f64,
    /// Alarm, s.
    pub alarm_s: Option<f64>,
    /// Time to the limit from the end on, h.
    pub left_h: f64,
}

/// Runs the scheme of figure 7.
pub(crate) fn run(seed: u64) -> SchemeRun {
    let mut scheme = Scheme::figure_7(seed);
    let gas = scheme.index(|stage| matches!(stage, Stage::GasTemperature(_)));
    let expected = scheme.index(|stage| matches!(stage, Stage::Expectation(_)));
    let actual = scheme.index(|stage| matches!(stage, Stage::Sum(signs) if signs.len() == 3));
    let error = scheme.index(|stage| matches!(stage, Stage::Sum(signs) if signs.len() == 2));
    let alarm = scheme.index(|stage| matches!(stage, Stage::Threshold(_)));
    let slope = scheme.index(|stage| matches!(stage, Stage::Slope(_)));
    let mut run = SchemeRun::default();
    for n in 0..=(DURATION_S / SAMPLE_S) as u32 {
        let time_s = SAMPLE_S * f64::from(n);
        let shoulder_degc = if time_s <= ENTRY_S { SHOULDER_DEGC.0 } else { SHOULDER_DEGC.1 };
        let values = scheme.step(time_s, &[shoulder_degc + ZERO_CELSIUS_K]);
        run.time_s.push(time_s);
        run.shoulder_degc.push(shoulder_degc);
        run.gas_degc.push(values[gas] - ZERO_CELSIUS_K);
        run.expected_bar.push(values[expected] / BAR);
        run.actual_bar.push(values[actual] / BAR);
        run.error_bar.push(values[error] / BAR);
        if values[alarm] > 0.0 {
            run.alarm_s = run.alarm_s.or(Some(time_s));
        }
        run.rate_bar_h = values[slope] * HOUR_S / BAR;
        run.left_h = (values[actual] - LIMIT_PA) / values[slope] / HOUR_S;
    }
    run
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluation::baseline::{Reading, Threshold};
    use approx::assert_abs_diff_eq;

    #[test]
    fn the_drawn_graph_of_figure_5_is_the_papers_detector_to_the_last_digit() {
        let mut scheme = Scheme::figure_5();
        let mut detector = Threshold::published(FULL);
        let held = scheme.index(|stage| matches!(stage, Stage::Sustained(_)));
        let slope = scheme.index(|stage| matches!(stage, Stage::Slope(_)));
        for n in 0..400 {
            let time_s = 30.0 * f64::from(n);
            let (shoulder_k, pressure_pa) = (280.0 + (0.01 * time_s).sin() * 9.0, 195e5 - 20.0 * time_s);
            let values = scheme.step(time_s, &[shoulder_k, pressure_pa]);
            let statistic = detector.update(Reading { time_s, shoulder_k, pressure_pa });
            assert_eq!(values[held], statistic);
            if let Some(loss) = detector.loss(LIMIT_PA) {
                assert_eq!(values[slope], loss.rate_pa_s);
            }
        }
    }

    #[test]
    fn the_papers_detector_finds_its_own_leak_two_minutes_and_the_holding_time_after_the_onset() {
        let run = run(8);
        let rise = |n: usize| run.expected_bar[n] - run.expected_bar[0];
        let end = run.time_s.len() - 1;
        // 45 K times a gain of 1.0331 times 0.8457 bar/K; 63 % of it after 331 s.
        assert_abs_diff_eq!(rise(end), 39.31, epsilon = 0.01);
        let later = run.time_s.iter().position(|&t| t >= ENTRY_S + 331.0).unwrap();
        assert_abs_diff_eq!(rise(later) / rise(end), 0.632, epsilon = 0.02);
        // 0.1 bar at 3 bar/h after 2 min, then 10 min; noise of 10 mbar must have left the threshold.
        let delay_min = (run.alarm_s.unwrap() - ONSET_S) / 60.0;
        assert!((12.0..13.0).contains(&delay_min), "{delay_min} min");
        assert_abs_diff_eq!(run.rate_bar_h, LOSS_BAR_H, epsilon = 0.03);
        // 218 bar less three hours of 3 bar/h, 160 bar: 49 bar.
        assert_abs_diff_eq!(run.left_h, 16.3, epsilon = 0.3);
        assert_eq!(run.time_s.len(), 1441);
    }

    #[test]
    fn every_arrow_joins_two_blocks_and_every_block_but_a_source_has_an_input() {
        for scheme in [Scheme::figure_4(), Scheme::figure_5(), Scheme::figure_7(1)] {
            let diagram = scheme.diagram();
            let count = diagram.nodes.len();
            assert!(diagram.arrows.iter().all(|arrow| arrow.from < arrow.to && arrow.to < count));
            let fed = |to: usize| diagram.arrows.iter().any(|arrow| arrow.to == to);
            let unfed = (0..count).filter(|&to| !fed(to)).count();
            // The shoulder; the pressure sensor; or noise and flow.
            assert_eq!(unfed, [3, 8, 10].iter().position(|&n| n == count).unwrap() + 1);
        }
    }
}
