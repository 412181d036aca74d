"""filterpy and Stone Soup on the linearised observer: 500 steps of prediction and update.

Errors are against the same recursion in extended precision (Joseph's form, 64 bits of mantissa): of the
state in standard deviations, of the covariance relative to the standard deviations of row and column.
"""

import datetime
import importlib.util
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stopwatch import Results, main, measure

Array = NDArray[Any]


class Problem:
    """The matrices as both libraries want them: whole, square and dense."""

    def __init__(self, inputs: Any) -> None:
        phi, g = np.array(inputs["phi"]), np.array(inputs["g"])
        leading, n = phi.shape
        self.f = np.eye(n)
        self.f[:leading] = phi
        self.q = np.zeros((n, n))
        self.q[:leading, :leading] = g @ np.diag(inputs["q"]) @ g.T
        self.h = np.array(inputs["h"])
        self.r = np.diag(inputs["r"])
        self.p = np.array(inputs["prior"])
        self.z = np.array(inputs["readings"])
        self.interval_s = float(inputs["interval_s"])


def extended(problem: Problem, g: Array, q: Array) -> tuple[Array, Array]:
    """The Kalman filter in extended precision."""
    p: Array
    f, h, r, p, z = (m.astype(np.longdouble) for m in (problem.f, problem.h, problem.r, problem.p, problem.z))
    g, q = g.astype(np.longdouble), q.astype(np.longdouble)
    noise = np.zeros_like(p)
    noise[: len(g), : len(g)] = (g * q) @ g.T
    x: Array = np.zeros(len(p), dtype=np.longdouble)
    one: Array = np.eye(len(p), dtype=np.longdouble)
    p = (p + p.T) / 2
    for sample in z:
        x, p = f @ x, f @ p @ f.T + noise
        for row, variance, value in zip(h, np.diag(r), sample):
            gain = p @ row / (row @ p @ row + variance)
            x = x + gain * (value - row @ x)
            left = one - np.outer(gain, row)
            p = left @ p @ left.T + variance * np.outer(gain, gain)
            p = (p + p.T) / 2
    return x, p


def errors(x: Array, p: Array, exact: tuple[Array, Array]) -> dict[str, float]:
    """Largest errors, and the smallest eigenvalue of the covariance in those units."""
    spread = np.sqrt(np.diag(exact[1]))
    scaled = np.asarray(p / np.outer(spread, spread), dtype=float)
    return {
        "state_error_sd": float(np.max(np.abs((x - exact[0]) / spread))),
        "covariance_error": float(np.max(np.abs((p - exact[1]) / np.outer(spread, spread)))),
        "smallest_eigenvalue": float(np.linalg.eigvalsh((scaled + scaled.T) / 2)[0]),
        "asymmetry": float(np.max(np.abs(scaled - scaled.T))),
    }


def filterpy(problem: Problem) -> Callable[[], tuple[Array, Array]]:
    from filterpy.kalman import KalmanFilter

    n, m = len(problem.p), len(problem.r)

    def run() -> tuple[Array, Array]:
        kf = KalmanFilter(dim_x=n, dim_z=m)
        kf.x, kf.F, kf.H = np.zeros((n, 1)), problem.f, problem.h
        kf.P, kf.Q, kf.R = problem.p.copy(), problem.q, problem.r
        for z in problem.z:
            kf.predict()
            kf.update(z.reshape(m, 1))
        return np.asarray(kf.x).reshape(n), np.asarray(kf.P)

    return run


def stone_soup(problem: Problem) -> Callable[[], tuple[Array, Array]]:
    from stonesoup.models.measurement.linear import LinearGaussian
    from stonesoup.models.transition.linear import LinearGaussianTimeInvariantTransitionModel
    from stonesoup.predictor.kalman import KalmanPredictor
    from stonesoup.types.detection import Detection
    from stonesoup.types.hypothesis import SingleHypothesis
    from stonesoup.types.state import GaussianState
    from stonesoup.updater.kalman import KalmanUpdater

    n = len(problem.p)

    class Readings(LinearGaussian):  # type: ignore[misc]
        """Stone Soup's linear measurement picks single states; this one has a matrix."""

        def matrix(self, **_: Any) -> Array:
            return problem.h

    transition = LinearGaussianTimeInvariantTransitionModel(
        transition_matrix=problem.f, covariance_matrix=problem.q
    )
    readings = Readings(ndim_state=n, mapping=tuple(range(len(problem.h))), noise_covar=problem.r)
    predictor, updater = KalmanPredictor(transition), KalmanUpdater(readings)
    start = datetime.datetime(2000, 1, 1)
    step = datetime.timedelta(seconds=problem.interval_s)
    # Detections are what comes in: they are made before the clock runs.
    detections = [
        Detection(z.reshape(-1, 1), timestamp=start + (k + 1) * step) for k, z in enumerate(problem.z)
    ]

    def run() -> tuple[Array, Array]:
        state = GaussianState(np.zeros((n, 1)), problem.p, timestamp=start)
        for detection in detections:
            prediction = predictor.predict(state, timestamp=detection.timestamp)
            state = updater.update(SingleHypothesis(prediction, detection))
        return np.asarray(state.state_vector, dtype=float).reshape(n), np.asarray(state.covar, dtype=float)

    return run


def numpy(problem: Problem) -> Callable[[], tuple[Array, Array]]:
    """What NumPy alone needs for the textbook's formulas: the least that any Python library can take."""

    def run() -> tuple[Array, Array]:
        f, q, h, r, p = problem.f, problem.q, problem.h, problem.r, problem.p
        x = np.zeros(len(p))
        for z in problem.z:
            x, p = f @ x, f @ p @ f.T + q
            ph = p @ h.T
            gain = np.linalg.solve(h @ ph + r, ph.T).T
            x, p = x + gain @ (z - h @ x), p - gain @ ph.T
        return x, p

    return run


def case(inputs: Any, first: bool) -> Results:
    del first
    problem = Problem(inputs["filter"])
    exact = extended(problem, np.array(inputs["filter"]["g"]), np.array(inputs["filter"]["q"]))
    peers: dict[str, Callable[[], tuple[Array, Array]]] = {"NumPy alone, textbook form": numpy(problem)}
    if importlib.util.find_spec("filterpy"):
        peers["filterpy, KalmanFilter"] = filterpy(problem)
    if importlib.util.find_spec("stonesoup"):
        peers["Stone Soup, KalmanPredictor and KalmanUpdater"] = stone_soup(problem)
    rows = []
    for name, run in peers.items():
        rows.append({"name": name} | errors(*run(), exact) | {"time": measure(run, parts=len(problem.z))})
    return {
        "peers": rows,
        "exact_x": exact[0].astype(float).tolist(),
        "exact_p": exact[1].astype(float).tolist(),
    }


if __name__ == "__main__":
    packages = {"numpy": "numpy", "filterpy": "filterpy", "stonesoup": "stonesoup"}
    main(case, [name for name in packages if importlib.util.find_spec(name)])
