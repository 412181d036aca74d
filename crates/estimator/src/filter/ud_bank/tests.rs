use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::filter::Linearisation;

/// Sizes of the first case.
struct FirstSizes;

impl Unrolled for FirstSizes {
    const SIZES: (usize, usize) = (18, 9);
}

/// Four filters, and the same in a bank.
struct Case {
    rng: ChaCha8Rng,
    n: usize,
    m: usize,
    pattern: Vec<Vec<usize>>,
    single: [UdFactors; 4],
    bank: UdBank,
}

impl Case {
    /// `n` states of which `m` move; the first `coupled` rows of the transition are dense.
    fn new(seed: u64, (n, m, coupled): (usize, usize, usize)) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let pattern = (0..m)
            .map(|row| if row < coupled { (0..n - 1).collect() } else { vec![row, (row + 1).min(m - 1)] })
            .collect();
        let mut bank = UdBank::new(n, m);
        let single = std::array::from_fn(|lane| {
            let root =
                DMatrix::from_fn(n, n + 2, |i, _| 10_f64.powi(i as i32 % 3) * rng.random_range(-1.0..1.0));
            let factors = UdFactors::from_covariance(&(&root * root.transpose())).unwrap();
            bank.set(lane, &factors);
            factors
        });
        Self { rng, n, m, pattern, single, bank }
    }

    fn assert_equal(&self) {
        for (lane, single) in self.single.iter().enumerate() {
            let (found, expected) = (self.bank.covariance(lane), single.covariance());
            let sd = expected.diagonal().map(|d| d.sqrt().max(1e-6));
            let worst = (&found - &expected).map_with_location(|i, j, e| (e / (sd[i] * sd[j])).abs()).max();
            assert!(worst < 1e-11, "lane {lane} of {} states: {worst}", self.n);
            let mut alone = vec![0.0; self.n];
            (0..self.n).for_each(|i| {
                single.write_column(i, &mut alone);
                for j in 0..self.n {
                    let scale = sd[i] * sd[j];
                    assert!((self.bank.covariance_of(lane, i, j) - found[(j, i)]).abs() < 1e-12 * scale);
                    assert!((alone[j] - expected[(j, i)]).abs() < 1e-12 * scale);
                }
                assert!(
                    (self.bank.variance(lane, i) - expected[(i, i)]).abs()
                        < 1e-11 * expected[(i, i)].max(1e-12)
                );
            });
        }
    }

    fn predict(&mut self, rank: usize) {
        let (n, m, rng) = (self.n, self.m, &mut self.rng);
        let mut transition = BankTransition::new(Pattern::new(&self.pattern));
        for (lane, single) in self.single.iter_mut().enumerate() {
            let mut phi = DMatrix::zeros(m, n);
            for (row, columns) in self.pattern.iter().enumerate() {
                columns.iter().for_each(|&column| phi[(row, column)] = rng.random_range(-1.0..1.0));
            }
            let root = DMatrix::from_fn(m, rank, |_, _| rng.random_range(-1.0..1.0));
            let noise = &root * root.transpose();
            transition.set(std::array::from_fn(|other| other == lane), phi.as_slice());
            transition
                .set_noise(std::array::from_fn(|other| other == lane), |place| Lanes::splat(noise[place]));
            single.predict(&Linearisation { phi, g: root, q: DVector::from_element(rank, 1.0) });
        }
        self.bank.predict::<FirstSizes>(&mut transition, &mut UdMemory::new(n, m));
    }

    fn update(&mut self, r: f64, used: [bool; 4]) {
        let n = self.n;
        let h: [DVector<f64>; 4] = std::array::from_fn(|_| {
            DVector::from_fn(n, |i, _| if i % 3 == 0 { self.rng.random_range(-1.0..1.0) } else { 0.0 })
        });
        let lanes: Vec<Lanes> = (0..n).map(|i| Lanes(std::array::from_fn(|lane| h[lane][i]))).collect();
        let projected = self.bank.project::<FirstSizes>(&lanes);
        let mut gains = vec![Lanes::ZERO; n];
        let s =
            self.bank.update::<FirstSizes>(Lanes::splat(r), used, &mut gains, &mut UdMemory::new(n, self.m));
        for lane in 0..4 {
            if !used[lane] {
                assert!(gains.iter().all(|gain| gain.0[lane] == 0.0));
                continue;
            }
            let mut gain = vec![0.0; n];
            let expected = self.single[lane].update(h[lane].as_slice(), r, &mut gain);
            assert!((s.0[lane] / expected - 1.0).abs() < 1e-11 || expected == 0.0);
            assert!(((projected.0[lane] + r) / expected - 1.0).abs() < 1e-11 || expected == 0.0);
            let size = gain.iter().fold(0.0_f64, |most, gain| most.max(gain.abs()));
            assert!((0..n).all(|i| (gains[i].0[lane] - gain[i]).abs() <= 1e-11 * size));
        }
    }
}

const SIZES: [(usize, usize, usize); 6] =
    [(18, 9, 4), (20, 11, 6), (7, 7, 0), (5, 3, 3), (2, 1, 1), (12, 10, 10)];

#[test]
fn four_filters_in_lanes_are_four_filters() {
    for (seed, sizes) in SIZES.into_iter().enumerate() {
        let mut case = Case::new(seed as u64, sizes);
        case.assert_equal();
        for round in 0..6 {
            case.predict(if round == 3 { 1 } else { case.m });
            case.assert_equal();
            case.update(0.3, [true, round != 1, true, round % 2 == 0]);
            case.update(0.0, [round == 4, true, false, true]);
            case.assert_equal();
        }
    }
}

#[test]
fn an_event_in_one_lane_leaves_the_others() {
    for (seed, sizes) in SIZES.into_iter().enumerate() {
        let mut case = Case::new(20 + seed as u64, sizes);
        let state = case.m / 2;
        case.bank.decorrelate_and_set(2, state, 0.7);
        case.single[2].decorrelate_and_set(state, 0.7);
        case.assert_equal();
        let variances = [0.1, 0.0, 2.0, 1e-9];
        case.bank.inflate(case.n - 1, Lanes(variances));
        case.bank.scale(case.n - 1, 0.4);
        for (single, variance) in case.single.iter_mut().zip(variances) {
            single.inflate(case.n - 1, variance);
            single.scale(case.n - 1, 0.4);
        }
        case.assert_equal();
        case.bank.copy_lane(2, 0);
        case.single[0] = case.single[2].clone();
        case.assert_equal();
    }
}

#[test]
fn a_state_known_exactly_stays_so_until_noise_comes() {
    let (mut bank, mut memory) = (UdBank::new(3, 2), UdMemory::new(3, 2));
    let mut gain = [Lanes::ZERO; 3];
    let h = [Lanes::splat(1.0); 3];
    assert_eq!(bank.project::<FirstSizes>(&h), Lanes::ZERO);
    assert_eq!(bank.update::<FirstSizes>(Lanes::ZERO, [true; 4], &mut gain, &mut memory), Lanes::ZERO);
    assert!(gain.iter().all(|gain| gain.is_zero()));
    let mut transition = BankTransition::new(Pattern::new(&[vec![0, 1], vec![1]]));
    bank.predict::<FirstSizes>(&mut transition, &mut memory);
    assert_eq!(bank.covariance(1), DMatrix::zeros(3, 3));
    let only = |(i, j)| if (i, j) == (1, 1) { 4.0 } else { 0.0 };
    transition.set_noise([false, true, false, false], |place| Lanes::splat(only(place)));
    bank.predict::<FirstSizes>(&mut transition, &mut memory);
    assert_eq!([0, 1, 2, 3].map(|lane| bank.variance(lane, 1)), [0.0, 4.0, 0.0, 0.0]);
}

#[test]
fn constants_alone_do_not_move() {
    let mut case = Case::new(40, (3, 0, 0));
    case.bank
        .predict::<FirstSizes>(&mut BankTransition::new(Pattern::new(&[])), &mut UdMemory::new(case.n, 0));
    case.assert_equal();
}
