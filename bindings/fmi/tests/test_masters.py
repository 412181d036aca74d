"""Other programs that simulate with the units."""

import fmpy
import numpy as np
import pytest
from conftest import READINGS, STEP_S, cylwatch, table

STEPS = 30
COOLING = """
name = "cooling"
duration_s = 1800
sample_time_s = 60
[initial]
fill_pressure_bar = 200
fill_temperature_degc = 15
temperature_k = 288.15
[ambient]
air_k = 268.15
wind_m_s = 3
"""
SURROUNDINGS = {"air_k": 268.15, "wind_m_s": 3.0}


@pytest.fixture(scope="module")
def cooled(tmp_path_factory):
    """Mass, kg, and pressure, Pa, at the end by the program."""
    folder = tmp_path_factory.mktemp("cooled")
    (folder / "scenario.toml").write_text(COOLING)
    cylwatch(folder, "simulate", "nitrogen-20l", "scenario.toml", "-o", "run.csv", "--relative-tolerance", "1e-9")
    run = table(folder / "run.csv")
    return float(run["mass_kg"][-1]), 1e5 * float(run["pressure_bar"][-1])


def test_fmpy_simulates_the_plant(archives, version, cooled):
    result = fmpy.simulate_fmu(
        str(archives["plant", version]),
        stop_time=STEPS * STEP_S,
        output_interval=STEP_S,
        start_values={"relative_tolerance": 1e-9, **SURROUNDINGS},
        output=["pressure_pa", "mass_kg"],
    )
    assert len(result) == STEPS + 1
    assert result["mass_kg"][-1] == pytest.approx(cooled[0], rel=1e-9)
    assert result["pressure_pa"][-1] == pytest.approx(cooled[1], rel=1e-6)


def test_fmpy_simulates_the_monitor_from_a_table(archives, version):
    times = STEP_S * np.arange(STEPS)
    columns = [times, np.full(STEPS, 288.15), np.full(STEPS, 288.15), np.full(STEPS, 200e5)]
    rows = np.array(list(zip(*columns)), dtype=[("time", float), *((name, float) for name in READINGS)])
    result = fmpy.simulate_fmu(
        str(archives["monitor", version]),
        stop_time=times[-1],
        output_interval=STEP_S,
        input=rows,
        output=["mass_kg", "mass_sd_kg", "verdict", "rows"],
    )
    # 200 bar of nitrogen at 15 degC in 20 l, by the equation of state of Span and others.
    assert result["mass_kg"][-1] == pytest.approx(4.49, rel=0.02)
    assert result["verdict"][-1] == 6 and result["rows"][-1] >= STEPS - 3


def test_ecos_wires_plant_and_monitor(archives, version, cooled):
    import ecospy as ecos

    structure = ecos.EcosSimulationStructure()
    structure.add_model("plant", str(archives["plant", version]))
    structure.add_model("monitor", str(archives["monitor", version]))
    for name in READINGS:
        structure.make_real_connection(f"plant::measured_{name}", f"monitor::{name}")
    start = {"plant::relative_tolerance": 1e-9, **{f"plant::{name}": value for name, value in SURROUNDINGS.items()}}
    structure.add_parameter_set("start", start)
    simulation = ecos.EcosSimulation(structure=structure, step_size=STEP_S)
    simulation.init(0.0, "start")
    simulation.step(STEPS)
    assert simulation.get_real("plant::mass_kg") == pytest.approx(cooled[0], rel=1e-9)
    assert simulation.get_real("plant::pressure_pa") == pytest.approx(cooled[1], rel=1e-6)
    assert simulation.get_real("monitor::mass_kg") == pytest.approx(cooled[0], rel=0.02)
    # Ecos leaves enumerations out.
    assert simulation.get_integer("monitor::exit_code") == 3
    simulation.terminate()


def test_libcosim_wires_plant_and_monitor(archives, cooled):
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    execution = CosimExecution.from_step_size(step_size=int(STEP_S * 1e9))
    index, references = {}, {}
    for kind in ("plant", "monitor"):
        archive = str(archives[kind, "2"])
        index[kind] = execution.add_local_slave(CosimLocalSlave(fmu_path=archive, instance_name=kind))
        description = fmpy.read_model_description(archive)
        references[kind] = {one.name: one.valueReference for one in description.modelVariables}
    for name, value in {"relative_tolerance": 1e-9, **SURROUNDINGS}.items():
        execution.real_initial_value(index["plant"], references["plant"][name], value)
    for name in READINGS:
        execution.connect_real_variables(
            index["plant"], references["plant"][f"measured_{name}"], index["monitor"], references["monitor"][name]
        )
    observer = CosimObserver.create_last_value()
    execution.add_observer(observer)
    assert execution.simulate_until(int(STEPS * STEP_S * 1e9))
    mass, pressure = (references["plant"][name] for name in ("mass_kg", "pressure_pa"))
    said = observer.last_real_values(index["plant"], [mass, pressure])
    assert said[0] == pytest.approx(cooled[0], rel=1e-9)
    assert said[1] == pytest.approx(cooled[1], rel=1e-6)
    # libcosim leaves enumerations out.
    names = [references["monitor"][name] for name in ("rows", "exit_code")]
    rows, code = observer.last_integer_values(index["monitor"], names)
    assert rows >= STEPS - 2 and code == 3
