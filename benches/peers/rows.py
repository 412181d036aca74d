"""From the results of both sides to comparable rows: time and error of each, and what the error is of."""

import math
from typing import Any

Row = dict[str, Any]
# Differences below these are rounding, or nothing that anybody would notice.
ROUNDING = 1e-9
LABELS = {
    "vessels": "HydDown: whole runs",
    "properties": "CoolProp: properties of nitrogen",
    "integration": "scipy and SUNDIALS: integrators",
    "filter": "filterpy and Stone Soup: a step of a filter",
    "horizon": "do-mpc: a step of a moving horizon",
}


def row(what: str, peer: str, ours: tuple[float, float, str], theirs: tuple[float, float, str]) -> Row:
    """Each side is (time, error, error in words); an error of NaN is not compared."""
    return {
        "what": what,
        "peer": peer,
        "ours_s": ours[0],
        "ours_error": ours[1],
        "ours_accuracy": ours[2],
        "peer_s": theirs[0],
        "peer_error": theirs[1],
        "peer_accuracy": theirs[2],
        "ratio": theirs[0] / ours[0],
    }


def best(timing: dict[str, float]) -> float:
    return timing["minimum_s"]


def vessels(ours: Any, peer: Any) -> list[Row]:
    rows = []

    def score(run: Any) -> tuple[float, float, str]:
        words = "gas {gas_rms_k:.2f} K, wall {wall_rms_k:.2f} K, pressure {pressure_rms_bar:.2f} bar"
        return best(run["time"]), run["gas_rms_k"], words.format(**run)

    lumped, resolved, fitted = ours["blowdown"]
    theirs = peer["blowdown"][0]
    coefficient = lumped["discharge_coefficient"]
    at = f"run I1, Cd {coefficient}, "
    rows.append(row(at + "one wall node on both sides", "HydDown", score(lumped), score(theirs)))
    coarse = (best(lumped["coarse_time"]), *score(lumped)[1:])
    rows.append(row(at + "the same, ours with a sample every 0.5 s", "HydDown", coarse, score(theirs)))
    for other in peer["blowdown"][1:]:
        rows.append(
            row(at + "wall resolved: 60 cells, 11 nodes", "HydDown, 1-D wall", score(resolved), score(other))
        )
    fit = fitted["discharge_coefficient"]
    what = f"run I1, ours with Cd {fit:.2f} fitted to the pressure, HydDown with {coefficient}"
    rows.append(row(what, "HydDown", score(fitted), score(theirs)))
    high, low = ours["stratified_high_rms_k"], ours["stratified_low_rms_k"]
    words = f"warmest gas {high:.2f} K, coldest {low:.2f} K (constants fitted to this run)"
    stacked = (best(ours["stratified_time"]), math.nan, words)
    none = (best(theirs["time"]), math.nan, "one gas temperature only")
    rows.append(row("run I1, ours with 40 stacked gas cells", "HydDown", stacked, none))

    def ends(run: Any) -> tuple[float, float, str]:
        seconds, bar = run["time_63_error_s"], run["pressure_error_bar"]
        return best(run["time"]), abs(seconds), f"{seconds:+.2g} s, {1e3 * bar:+.2g} mbar"

    for step in peer["bottle"]:
        # The loosest tolerance whose time constant is at least as near to its limit.
        fits = [run for run in ours["bottle"] if abs(run["time_63_error_s"]) <= abs(step["time_63_error_s"])]
        run = fits[0] if fits else ours["bottle"][-1]
        what = (
            f"closed bottle, 6 h: ours at {run['tolerance']:.0e}, HydDown in steps of {step['step_s']:.0f} s"
        )
        rows.append(row(what, "HydDown", ends(run), ends(step)))
    return rows


def properties(ours: Any, peer: Any) -> list[Row]:
    names = {
        "pressure_pa": "p",
        "density_kg_m3": "rho",
        "cp_j_kg_k": "cp",
        "cv_j_kg_k": "cv",
        "viscosity_pa_s": "viscosity",
        "conductivity_w_m_k": "conductivity",
    }
    off = {
        short: max(abs(a / b - 1) for a, b in zip(ours[name], peer[name])) for name, short in names.items()
    }
    groups = {
        "pressure": ("p(rho, T)", ["p"]),
        "density": ("rho(p, T)", ["rho"]),
        "all": (
            "rho, cp, cv, viscosity, conductivity at (p, T)",
            ["rho", "cp", "cv", "viscosity", "conductivity"],
        ),
    }
    rows = []
    for key, (what, parts) in groups.items():
        words = "differ by " + ", ".join(
            f"{off[part]:.1e}" + (f" ({part})" if len(parts) > 1 else "") for part in parts
        )
        mine = (best(ours[f"{key}_time"]), math.nan, words)
        for peer_name, timing in (
            ("low-level interface", f"{key}_time"),
            ("PropsSI over the grid", f"bulk_{key}_time"),
        ):
            rows.append(row(what, f"CoolProp, {peer_name}", mine, (best(peer[timing]), math.nan, "the same")))
    return rows


def integration(ours: Any, peer: Any) -> list[Row]:
    rows = []
    for mine, theirs in zip(ours, peer["systems"]):
        runs = {run["tolerance"]: run for run in mine["runs"]}
        for other in theirs["rows"]:
            run = runs[other["tolerance"]]
            words = f"{run['error_k']:.1e} K, {run['steps']} steps, {run['newton_iterations']} iterations"
            steps = f", {other['steps']} steps" if other["steps"] else ""
            said = f"{other['error_k']:.1e} K{steps}, {other['rates']} evaluations"
            rows.append(
                row(
                    f"{mine['name']}, {other['tolerance']:.0e}",
                    other["name"],
                    (best(run["time"]), run["error_k"], words),
                    (best(other["time"]), other["error_k"], said),
                )
            )
    return rows


def filters(ours: Any, peer: Any) -> list[Row]:
    exact_x, exact_p = peer["exact_x"], peer["exact_p"]
    spread = [math.sqrt(exact_p[i][i]) for i in range(len(exact_x))]

    def error(x: Any, p: Any) -> float:
        state = max(abs(a - b) / s for a, b, s in zip(x, exact_x, spread))
        pairs = ((i, j) for i in range(len(x)) for j in range(len(x)))
        return float(max(state, *(abs(p[i][j] - exact_p[i][j]) / spread[i] / spread[j] for i, j in pairs)))

    mine = error(ours["x"], ours["covariance"])
    what = f"{len(exact_x)} states, 3 readings, UD factors"
    rows = []
    for other in peer["peers"]:
        theirs = max(other["state_error_sd"], other["covariance_error"])
        side = (best(ours["time"]), mine, f"{mine:.0e}")
        rows.append(row(what, other["name"], side, (best(other["time"]), theirs, f"{theirs:.0e}")))
    return rows


def horizon(ours: Any, peer: Any) -> list[Row]:
    pairs = zip(ours["newest"], peer["exact_newest"])
    mine = max(max(abs(a - b) for a, b in zip(x, best_x)) for x, best_x in pairs)
    pushes = f"bound pushes in {ours['active']} of {len(ours['newest'])} windows"
    what = f"20 samples, 18 states, 3 readings, leak not negative; {pushes}"
    side = (best(ours["time"]), mine, f"{mine:.0e} sd")
    return [
        row(what, "do-mpc, IPOPT", side, (best(peer["time"]), peer["error_sd"], f"{peer['error_sd']:.0e} sd"))
    ]


ROWS = {
    "vessels": vessels,
    "properties": properties,
    "integration": integration,
    "filter": filters,
    "horizon": horizon,
}


def better(rows: list[Row]) -> list[str]:
    """By peer, in how many of its rows it is faster or more accurate, with the row where it is most so."""
    found = []
    for peer in dict.fromkeys(row["peer"] for row in rows):
        of = [row for row in rows if row["peer"] == peer]
        said = []
        fast = [row for row in of if row["ratio"] < 1]
        if fast:
            most = min(fast, key=lambda row: float(row["ratio"]))
            times = f"{1 / most['ratio']:.2g} times as fast"
            said.append(f"faster in {len(fast)} of {len(of)} rows, at most {times} ({most['what']})")
        near = [row for row in of if is_nearer(row)]
        if near:
            most = min(near, key=lambda row: float(row["peer_error"] / row["ours_error"]))
            errors = f"{most['peer_error']:.2g} against {most['ours_error']:.2g}"
            said.append(f"more accurate in {len(near)} of {len(of)} rows, at most {errors} ({most['what']})")
        if said:
            found.append(f"{peer}: {'; '.join(said)}.")
    return found


def is_nearer(row: Row) -> bool:
    """Whether the peer's error is the smaller one, by more than a tenth and more than rounding."""
    mine, theirs = row["ours_error"], row["peer_error"]
    if mine is None or theirs is None or mine != mine or theirs != theirs:
        return False
    return bool(mine > ROUNDING and theirs < 0.9 * mine)
