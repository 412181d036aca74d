"""do-mpc (CasADi, IPOPT) on the same windows: prior, weights, samples and bound as given, states scaled.

Only the solution of the program is timed, not what do-mpc does around it (its records, its default of a
constant weight of the prior). Errors are against the optimum by an active-set method on orthogonal factors
of the whole window.
"""

import contextlib
import io
import warnings
from typing import Any

import casadi as ca
import do_mpc
import numpy as np
from numpy.typing import NDArray

from stopwatch import Results, main, measure

Array = NDArray[np.float64]
SILENT = {"ipopt.print_level": 0, "ipopt.sb": "yes", "print_time": 0}


class Problem:
    """Whole matrices of the scaled problem."""

    def __init__(self, inputs: Any) -> None:
        linear = inputs["linear"]
        phi, g = np.array(linear["phi"]), np.array(linear["g"])
        self.leading, self.n = phi.shape
        self.f = np.eye(self.n)
        self.f[: self.leading] = phi
        self.g = g * np.sqrt(np.array(linear["q"]))
        self.noisy = [i for i in range(self.leading) if np.any(g[i])]
        self.quiet = [i for i in range(self.n) if i not in self.noisy]
        self.noise = self.g[self.noisy] @ self.g[self.noisy].T
        self.h, self.r = np.array(linear["h"]), np.array(linear["r"])
        self.prior = np.array(linear["prior"])
        self.samples, self.bounded = int(inputs["samples"]), int(inputs["bounded"])
        self.interval_s = float(linear["interval_s"])


def estimator(problem: Problem) -> Any:
    """A moving-horizon estimator of do-mpc: states that noise drives, then the others."""
    model = do_mpc.model.Model("discrete", symvar_type="SX")
    noisy = model.set_variable("_x", "noisy", shape=(len(problem.noisy), 1))
    quiet = model.set_variable("_x", "quiet", shape=(len(problem.quiet), 1))
    order = problem.noisy + problem.quiet
    x = ca.vertcat(noisy, quiet)
    model.set_meas("z", ca.sparsify(ca.DM(problem.h[:, order])) @ x, meas_noise=True)
    for name, rows, noise in (("noisy", problem.noisy, True), ("quiet", problem.quiet, False)):
        model.set_rhs(name, ca.sparsify(ca.DM(problem.f[np.ix_(rows, order)])) @ x, process_noise=noise)
    model.setup()
    mhe = do_mpc.estimator.MHE(model)
    settings = mhe.settings
    settings.n_horizon, settings.t_step = problem.samples, problem.interval_s
    settings.store_full_solution, settings.meas_from_data = False, True
    settings.nlpsol_opts = SILENT | {"ipopt.tol": 1e-10}
    mhe.set_default_objective(
        P_x=np.linalg.inv(problem.prior[np.ix_(order, order)]),
        P_v=np.diag(1 / problem.r),
        P_w=np.linalg.inv(problem.noise),
    )
    mhe.setup()
    # The bound holds at every sample.
    for k in range(1, problem.samples + 1):
        mhe.lb_opt_x["_x", k, -1, "noisy", problem.noisy.index(problem.bounded)] = 0.0
    return mhe


def solve(mhe: Any, problem: Problem, window: Array) -> Array:
    """Newest state of the optimum of a window with a prior of mean zero."""
    mhe.opt_p_num["_x_prev"] = 0
    for k, z in enumerate(window):
        mhe.opt_p_num["_y_meas", k] = z
    mhe.solve()
    found = np.empty(problem.n)
    found[problem.noisy + problem.quiet] = np.array(mhe.opt_x_num["_x", problem.samples, -1]).ravel()
    return found


def cost(problem: Problem, root: Array, window: Array) -> tuple[Array, Array, Array]:
    """Residuals `A v - b` of a window in `v = (start, noises)`, with the matrices that give the states."""
    k = problem.g.shape[1]
    columns = problem.n + problem.samples * k
    state = np.zeros((problem.n, columns))
    state[:, : problem.n] = root
    rows, right, states = [np.eye(columns)], [np.zeros(columns)], []
    for i, z in enumerate(window):
        state = problem.f @ state
        state[: problem.leading, problem.n + i * k : problem.n + (i + 1) * k] += problem.g
        states.append(state)
        rows.append(problem.h @ state / np.sqrt(problem.r)[:, None])
        right.append(z / np.sqrt(problem.r))
    return np.vstack(rows), np.concatenate(right), np.array(states)


def exact(problem: Problem, window: Array) -> tuple[Array, float]:
    """Newest state and half the sum of squares at the optimum, by an active set on orthogonal factors."""
    a, b, states = cost(problem, np.linalg.cholesky(problem.prior), window)
    bounds = states[:, problem.bounded, :]
    active: list[int] = []
    q, r = np.linalg.qr(a)
    free = np.linalg.solve(r, q.T @ b)
    solution = free
    for _ in range(4 * len(window)):
        if active:
            rows = bounds[active]
            pull = np.linalg.solve(r.T, rows.T)
            multiplier = np.linalg.solve(pull.T @ pull, -(rows @ free))
            solution = free + np.linalg.solve(r, pull @ multiplier)
            worst = int(np.argmin(multiplier))
            if multiplier[worst] < 0:
                active.pop(worst)
                continue
        values = bounds @ solution
        values[active] = 0
        lowest = int(np.argmin(values))
        if values[lowest] > -1e-13:
            break
        active.append(lowest)
    return states[-1] @ solution, 0.5 * float(np.sum((a @ solution - b) ** 2))


def case(inputs: Any, first: bool) -> Results:
    del first
    warnings.simplefilter("ignore", FutureWarning)
    inputs = inputs["horizon"]
    problem = Problem(inputs)
    windows = [np.array(window) for window in inputs["windows"]]
    optimum = [exact(problem, window) for window in windows]
    with contextlib.redirect_stdout(io.StringIO()):
        mhe = estimator(problem)
        newest = [solve(mhe, problem, window) for window in windows]
        solved = [bool(mhe.solver_stats["success"])]
        timing = measure(lambda: [solve(mhe, problem, window) for window in windows], parts=len(windows))
    spread = np.sqrt(np.diag(problem.prior))
    errors = [np.max(np.abs(found - best) / spread) for found, (best, _) in zip(newest, optimum)]
    return {
        "exact_newest": [best.tolist() for best, _ in optimum],
        "exact_cost": [value for _, value in optimum],
        "error_sd": float(max(errors)),
        "solved": solved,
        "time": timing,
    }


if __name__ == "__main__":
    main(case, ["do-mpc", "casadi"])
