"""The book's chapter from `results.json`: tables by case, and in words what they are worth."""

from typing import Any

import rows as comparison

HEAD = """# Peers

Other programs do parts of what this project does. `benches/peers/run` installs them from PyPI, gives both sides the same
inputs, and writes this page with what came out; a peer that cannot be installed is left out and named. Nothing here is edited by hand.
"""

READING = """## How to read it

A ratio is the peer's time over ours: above 1 we are faster. Times are the best of all repetitions over {rounds} rounds in which both sides
take turns, one thread, warm, without start-up, import, file reading and, where a solver is built once (CasADi, do-mpc), without building it.
Ours are wall times of a Rust program, those of the peers CPU times: load of the machine counts against us, not against them. The rest
of the distribution stands in `benches/peers/results.json`. Load is the mean number of running programs in the minute before a case; above
the number of cores, times are longer than on an idle machine, and ratios are good to a factor of about 2.

Most peers are Python around compiled code, and a ratio says what a user of both gets, not what their algorithms are worth. The
compiled peers are CoolProp (C++, with the calls from Python taken off), CasADi's CVODES, and CVODE from C.
"""

NOTES = {
    "vessels": """Accuracy on run I1 is the root mean square against the measured record at its digitised points: gas against the middle of the measured
band, wall against its upper edge, pressure. HydDown's inputs are those that it publishes for this run, in steps of 0.05 s; this project writes a
sample as often, which takes most of its time, and where it is said every 0.5 s. On the closed bottle it is the error of the time to 63 % of the step (samples of 60 s) and of the final pressure, each against the program's own
converged run (HydDown's extrapolated from steps of 4 and 2 s): what the model is worth does not enter, and our tolerance is the loosest
one whose time constant is at least as good. At the end, near rest, an explicit step
has hardly an error left, and HydDown's pressure is the nearer one. The two models agree in the limit to {limit_s:.1f} s of {time_63_s:.0f} s.

HydDown scores better on the gas and the pressure of run I1 at its own discharge coefficient: the throat of the real gas, which we use, passes 4 to 6 %
more than the formula for the ideal gas that HydDown uses with this coefficient. The fitted coefficient uses the measured pressure; the gas
temperature is not fitted. HydDown also takes mixtures, two phases, fire and relief valves, which we do not. The measured gas band is 19 K wide on average.
""",
    "properties": """210 states, 220 to 350 K and 1 to 300 bar, one gas phase. Differences are relative, the largest over the grid, between two
implementations of the same equations (Span et al. 2000, Lemmon and Jacobsen 2004): neither is the truth. CoolProp updates a whole state
at each call and knows more than a hundred fluids, mixtures and two phases; its tables were not tried. From the low-level
interface two to six empty calls are taken off for each state ({overhead_ns:.0f} ns for two); PropsSI is as it is.
""",
    "integration": """The closed bottle over 6 h, 61 samples, the same relative tolerance, an absolute one of 100 K times as much, the same first step. The
derivatives of both sides agree to {derivatives:.0e} at five states (ours interpolates the film's properties), the reference solutions to
{references:.0e} K. Errors are of the gas temperature against the own reference at 1e-11 or below.

What is not the same favours the peers: their properties are polynomials in the temperature, which a closed bottle allows, while ours
evaluates the equation of state, fills its table of the film anew in each run, builds mesh and model (a run that ends after 1 s takes
{short_us:.0f} us with one wall cell), carries mass, mean wall and four balances beside the states, and writes surfaces, places and heat flows
at each sample. scipy and scikit-SUNDAE call a right-hand side in NumPy ({rate_us:.0f} us, with CoolProp
{coolprop_us:.0f} us, ours {own_rate_us:.1f} us for {name}) and take Jacobians by differences, as CVODE from C ({c_words}) does; ours and CasADi's are exact. At equal
tolerance our errors are mostly the larger ones: compare at equal error, a row further down.
""",
    "filter": """The observer half an hour after a cylinder entered a tunnel in winter, its transition, noise, gradients and covariance held constant, 500 samples every
10 s. Accuracy is the largest error after the last one, of the state in standard deviations or of the covariance relative to those of row
and column, against the same filter in extended precision. On this problem every form is exact to rounding: what factors are for
is shown by ill-conditioned ones, in the tests. Ours knows that nine states are constants; the others multiply whole matrices.
Stone Soup carries time stamps, types and hypotheses with each step, which is what it is for.
""",
    "horizon": """The same process with states in standard deviations, the mass without noise of its own, weights, prior, samples and the bound as given, 20 windows. Accuracy
is of the newest state against the optimum by an active-set method in Python. Our time is that of a sample in a moving window, estimate and
covariance included; do-mpc's is the solution of one window alone by IPOPT, started from the last one, without what do-mpc does around it. do-mpc takes any smooth
nonlinear model and constraint and differentiates it; ours takes linear constraints. IPOPT is a solver for any smooth program, and this one is quadratic.
""",
}


def seconds(value: float) -> str:
    """Three digits with a unit that suits."""
    for unit, scale in (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)):
        if value >= scale:
            return f"{value / scale:.3g} {unit}"
    return f"{value / 1e-9:.3g} ns"


def table(rows: list[comparison.Row]) -> str:
    lines = [
        "| what is compared | peer | ours: time | ours: accuracy | peer: time | peer: accuracy | ratio |",
        "|---|---|---|---|---|---|---|",
    ]
    for one in rows:
        cells = [
            one["what"],
            one["peer"],
            seconds(one["ours_s"]),
            one["ours_accuracy"],
            seconds(one["peer_s"]),
            one["peer_accuracy"],
            f"**{one['ratio']:.2g}**" if one["ratio"] < 100 else f"**{one['ratio']:.0f}**",
        ]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def circumstances(results: dict[str, Any]) -> str:
    machine, versions = results["machine"], results["versions"]
    loads = ", ".join(f"{name} {load:.1f}" for name, load in results["load"].items())
    parts = [
        f"{results['date']}; {machine['cpu']}, {machine['cores']} cores, {machine['system']}; {machine['rustc']}, Python "
        f"{machine['python']}; "
        + ", ".join(f"{name} {version}" for name, version in sorted(versions.items()))
        + ".",
        f"Load: {loads}.",
    ]
    if max(results["load"].values()) > float(machine["cores"]):
        parts.append("**The machine was busy with other work.**")
    if results["skipped"]:
        parts.append(
            "Skipped: " + "; ".join(f"{name} ({why})" for name, why in results["skipped"].items()) + "."
        )
    return " ".join(parts) + "\n"


def render(results: dict[str, Any]) -> str:
    """The whole page."""
    parts = [HEAD, circumstances(results), READING.format(rounds=results["rounds"])]
    everything: list[comparison.Row] = []
    for name, case in results["cases"].items():
        parts.append(f"## {comparison.LABELS[name]}\n")
        parts.append(table(case["rows"]))
        parts.append(NOTES[name].format(**case["facts"]))
        everything += case["rows"]
    found = comparison.better(everything)
    parts.append("## Where a peer is better\n")
    parts.append(
        "\n".join(f"* {sentence}" for sentence in found) + "\n" if found else "In none of the rows.\n"
    )
    return "\n".join(parts)
