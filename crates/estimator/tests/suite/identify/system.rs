//! A system in modal form: the response of each pole to a straight input is a closed form in exponentials.
use cylwatch_estimator::identify::{Data, Hold, Identified};
use nalgebra::Complex;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

type C = Complex<f64>;

/// `y = sum_i r_i/(s - p_i) e^(-s delta) u + sum_i f_i e^(p_i t) + offset`.
#[derive(Clone, Debug)]
pub(crate) struct System {
    pub poles: Vec<C>,
    pub residues: Vec<C>,
    /// Parts of the free response at the start.
    pub free: Vec<C>,
    pub dead_time_s: f64,
    pub offset: f64,
}

impl System {
    /// With real poles.
    pub(crate) fn real(poles: &[f64], residues: &[f64]) -> Self {
        let complex = |values: &[f64]| values.iter().map(|v| C::new(*v, 0.0)).collect::<Vec<_>>();
        Self {
            poles: complex(poles),
            residues: complex(residues),
            free: vec![C::new(0.0, 0.0); poles.len()],
            dead_time_s: 0.0,
            offset: 0.0,
        }
    }

    /// The paper's.
    pub(crate) fn published() -> Self {
        Self::real(&[-0.003021], &[0.003121])
    }

    /// Starting off rest.
    pub(crate) fn free(mut self, parts: &[f64]) -> Self {
        self.free = parts.iter().map(|v| C::new(*v, 0.0)).collect();
        self
    }

    /// Coefficients, highest power first: numerator with as many zeros as wanted, denominator.
    pub(crate) fn coefficients(&self, zeros: usize) -> (Vec<f64>, Vec<f64>) {
        let mut den = vec![C::new(1.0, 0.0)];
        for pole in &self.poles {
            den = times(&den, *pole);
        }
        let mut num = vec![C::new(0.0, 0.0); self.poles.len()];
        for (i, residue) in self.residues.iter().enumerate() {
            let mut part = vec![*residue];
            for (_, pole) in self.poles.iter().enumerate().filter(|(j, _)| *j != i) {
                part = times(&part, *pole);
            }
            num.iter_mut().zip(part).for_each(|(sum, part)| *sum += part);
        }
        let skip = num.len() - 1 - zeros;
        let real = |values: &[C]| values.iter().map(|v| v.re).collect::<Vec<_>>();
        (real(&num[skip..]), real(&den))
    }

    /// Output at the times of the input.
    pub(crate) fn respond(&self, time_s: &[f64], input: &[f64], hold: Hold) -> Vec<f64> {
        let start_s = time_s[0];
        // Bends of the delayed input; before the first, the input has its first value.
        let bends: Vec<f64> = time_s.iter().map(|t| t - start_s + self.dead_time_s).collect();
        time_s
            .iter()
            .map(|t| t - start_s)
            .map(|t| {
                let mut y = C::new(self.offset, 0.0);
                for ((p, r), f) in self.poles.iter().zip(&self.residues).zip(&self.free) {
                    y += f * (p * t).exp();
                    // From the start to the first bend, then from bend to bend up to t.
                    let first = bends[0].min(t);
                    let mut x = held(*p, t, 0.0, first, input[0], 0.0);
                    for k in 0..bends.len() {
                        if bends[k] >= t {
                            break;
                        }
                        let (from, to) = (bends[k], bends.get(k + 1).map_or(t, |next| next.min(t)));
                        let slope = match (hold, bends.get(k + 1)) {
                            (Hold::First, Some(next)) => (input[k + 1] - input[k]) / (next - from),
                            _ => 0.0,
                        };
                        x += held(*p, t, from, to, input[k], slope);
                    }
                    y += r * x;
                }
                y.re
            })
            .collect()
    }

    /// A record.
    pub(crate) fn data(&self, time_s: Vec<f64>, input: Vec<f64>, hold: Hold) -> Data {
        let output = self.respond(&time_s, &input, hold);
        Data::try_new(time_s, input, output, hold).unwrap()
    }
}

/// `int_from^to e^(p (t - s)) (u + slope (s - from)) ds`.
fn held(p: C, t: f64, from: f64, to: f64, u: f64, slope: f64) -> C {
    let (early, late) = ((p * (t - from)).exp(), (p * (t - to)).exp());
    let area = (early - late) / p;
    area * u + ((area - late * (to - from)) / p) * slope
}

fn times(polynomial: &[C], root: C) -> Vec<C> {
    let mut product = polynomial.to_vec();
    product.push(C::new(0.0, 0.0));
    for (i, value) in polynomial.iter().enumerate() {
        product[i + 1] -= value * root;
    }
    product
}

pub(crate) fn random(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

/// Standard normal numbers.
pub(crate) fn normal(random: &mut ChaCha8Rng) -> f64 {
    StandardNormal.sample(random)
}

/// Times of regular samples, from a start other than zero.
pub(crate) fn regular(samples: usize, interval_s: f64) -> Vec<f64> {
    (0..samples).map(|k| 1000.0 + k as f64 * interval_s).collect()
}

/// Times with intervals from a third to five thirds of the mean.
pub(crate) fn irregular(samples: usize, interval_s: f64, seed: u64) -> Vec<f64> {
    let mut random = random(seed);
    let mut time_s = -500.0;
    (0..samples)
        .map(|_| {
            time_s += interval_s * (1.0 + 4.0 * random.random::<f64>()) / 3.0;
            time_s
        })
        .collect()
}

/// Levels that change now and then, with a ripple: rich in all frequencies.
pub(crate) fn levels(time_s: &[f64], seed: u64) -> Vec<f64> {
    let mut random = random(seed);
    let mut level = 20.0;
    time_s
        .iter()
        .map(|_| {
            if random.random::<f64>() < 0.05 {
                level = 60.0 * random.random::<f64>() - 20.0;
            }
            level + 0.5 * normal(&mut random)
        })
        .collect()
}

/// Largest relative error of the coefficients.
pub(crate) fn error(identified: &Identified, system: &System) -> f64 {
    let (num, den) = system.coefficients(identified.model.num.len() - 1);
    let found = identified.model.num.iter().chain(&identified.model.den);
    found.zip(num.iter().chain(&den)).map(|(found, truth)| (found / truth - 1.0).abs()).fold(0.0, f64::max)
}
