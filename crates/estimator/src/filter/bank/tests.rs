use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::filter::Linearisation;

/// Four filters, and the same in a bank.
struct Case {
    rng: ChaCha8Rng,
    n: usize,
    m: usize,
    pattern: Vec<Vec<usize>>,
    single: [UdFactors<Dyn>; 4],
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
            (0..self.n).for_each(|i| {
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
        self.bank.predict(&mut transition);
    }

    fn update(&mut self, r: f64, used: [bool; 4]) {
        let n = self.n;
        let h: [DVector<f64>; 4] = std::array::from_fn(|_| {
            DVector::from_fn(n, |i, _| if i % 3 == 0 { self.rng.random_range(-1.0..1.0) } else { 0.0 })
        });
        let lanes: Vec<Lanes> = (0..n).map(|i| Lanes(std::array::from_fn(|lane| h[lane][i]))).collect();
        let projected = self.bank.project(&lanes);
        let mut gains = vec![Lanes::ZERO; n];
        let s = self.bank.update(Lanes::splat(r), used, &mut gains);
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
    let mut bank = UdBank::new(3, 2);
    let mut gain = [Lanes::ZERO; 3];
    let h = [Lanes::splat(1.0); 3];
    assert_eq!(bank.project(&h), Lanes::ZERO);
    assert_eq!(bank.update(Lanes::ZERO, [true; 4], &mut gain), Lanes::ZERO);
    assert!(gain.iter().all(|gain| gain.is_zero()));
    let mut transition = BankTransition::new(Pattern::new(&[vec![0, 1], vec![1]]));
    bank.predict(&mut transition);
    assert_eq!(bank.covariance(1), DMatrix::zeros(3, 3));
    let only = |(i, j)| if (i, j) == (1, 1) { 4.0 } else { 0.0 };
    transition.set_noise([false, true, false, false], |place| Lanes::splat(only(place)));
    bank.predict(&mut transition);
    assert_eq!([0, 1, 2, 3].map(|lane| bank.variance(lane, 1)), [0.0, 4.0, 0.0, 0.0]);
}

#[test]
fn constants_alone_do_not_move() {
    let mut case = Case::new(40, (3, 0, 0));
    case.bank.predict(&mut BankTransition::new(Pattern::new(&[])));
    case.assert_equal();
}

#[test]
fn what_is_adopted_of_some_states_leaves_the_others_given_those_as_they_were() {
    let first = 6;
    let case = Case::new(11, (9, first, 3));
    let other = Case::new(12, (9, first, 3));
    for (from_own, from, to) in [(true, 1, 3), (false, 2, 0)] {
        let (before, theirs) =
            (case.bank.covariance(to), if from_own { &case.bank } else { &other.bank }.covariance(from));
        let (mut means, their_means) = ([1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0], [0.5; 9]);
        let old = means;
        let mut bank = case.bank.clone();
        bank.adopt((to, &mut means), ((!from_own).then_some(&other.bank), from, &their_means), first);
        let block = |p: &DMatrix<f64>, i: usize, j: usize| {
            let size = |at: usize| if at == 0 { first } else { 9 - first };
            p.view((i, j), (size(i), size(j))).into_owned()
        };
        let (cc, their_cc) = (block(&before, first, first), block(&theirs, first, first));
        // By matrices: B = P_xc P_cc^-1, P_xc' = B P_cc', P_xx' = P_xx - B (P_cc - P_cc') B^T.
        let b = block(&before, 0, first) * cc.clone().try_inverse().unwrap();
        let xx = block(&before, 0, 0) - &b * (&cc - &their_cc) * b.transpose();
        let xc = &b * &their_cc;
        let found = bank.covariance(to);
        for (i, j, expected) in [(0, 0, xx), (0, first, xc), (first, first, their_cc)] {
            let worst = (block(&found, i, j) - &expected).abs().max() / expected.abs().max();
            assert!(worst < 1e-9, "block {i}, {j}: {worst}");
        }
        let by = |bank: &UdBank, lane: usize| {
            let p = bank.covariance(lane);
            block(&p, 0, first).row(2) * block(&p, first, first).try_inverse().unwrap()
        };
        let theirs_of = if from_own { &case.bank } else { &other.bank };
        let apart = by(&case.bank, to) - by(theirs_of, from);
        let expected = (&apart * &cc * apart.transpose())[0];
        let found = case.bank.apart_by(to, (theirs_of, from), 2, first);
        assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
        let moved = b * DVector::from_fn(9 - first, |k, _| 0.5 - old[first + k]);
        for i in 0..9 {
            let expected = if i < first { old[i] + moved[i] } else { 0.5 };
            assert!((means[i] - expected).abs() < 1e-9 * expected.abs().max(1.0), "mean {i}");
        }
        // Nobody else's.
        (0..4)
            .filter(|lane| *lane != to)
            .for_each(|lane| assert_eq!(bank.covariance(lane), case.bank.covariance(lane)));
    }
}
