"""Archives for the tests, and a unit as a master holds it, in either version of the interface."""

import csv
import os
import shutil
import subprocess
from pathlib import Path

import fmpy
import pytest
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from fmpy.fmi3 import FMU3Slave

PROGRAM = os.environ["CYLWATCH"]
FILL = ["--fill-pressure-bar", "200", "--fill-temperature-degc", "15"]
STEP_S = 60.0
SENSORS = """
[[sensor]]
name = "shoulder"
air_coupling = 0.15

[[sensor]]
name = "valve"
air_coupling = 0.15

[[sensor]]
name = "pressure"
"""
READINGS = ["shoulder_k", "valve_k", "pressure_pa"]


def cylwatch(folder, *arguments):
    """Runs the program, which must not fail."""
    done = subprocess.run([PROGRAM, *map(str, arguments)], cwd=folder, capture_output=True, text=True)
    assert done.returncode != 2, done.stderr
    return done


def table(path):
    """A CSV of the program: names and columns, an empty cell is NaN."""
    with open(path, encoding="utf-8") as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    names, *rows = rows
    return {name: [row[at] for row in rows] for at, name in enumerate(names)}


@pytest.fixture(scope="session")
def archives(tmp_path_factory):
    """The four archives by kind and version."""
    folder = tmp_path_factory.mktemp("archives")
    (folder / "sensors.toml").write_text(SENSORS)
    made = {}
    for kind, more in [("plant", ["--sensors", "sensors.toml"]), ("monitor", [])]:
        for version in "23":
            path = folder / f"{kind}{version}.fmu"
            cylwatch(folder, "fmu", "nitrogen-20l", "--kind", kind, "--fmi", version, *FILL, *more, "-o", path)
            made[kind, version] = path
    return made


class Unit:
    """A unit in the hands of a master."""

    def __init__(self, archive, start_s=0.0, folder=None, **parameters):
        self.said = []
        self.description = fmpy.read_model_description(str(archive))
        self.folder = folder or fmpy.extract(str(archive))
        self.variables = {variable.name: variable for variable in self.description.modelVariables}
        self.is_2 = self.description.fmiVersion.startswith("2")
        identifier = self.description.coSimulation.modelIdentifier
        about = {"guid": self.description.guid, "unzipDirectory": str(self.folder), "modelIdentifier": identifier}
        if self.is_2:
            self.unit = FMU2Slave(**about, instanceName="unit")
            self.logger = fmi2CallbackLoggerTYPE(lambda *said: self.said.append(said[4].decode()))
            self.callbacks = fmi2CallbackFunctions(logger=self.logger)
            self.unit.instantiate(callbacks=self.callbacks)
            self.unit.setupExperiment(startTime=start_s)
            self.unit.enterInitializationMode()
        else:
            self.unit = FMU3Slave(**about, instanceName="unit")
            self.unit.instantiate(logMessage=lambda *said: self.said.append(said[3].decode()))
            self.unit.enterInitializationMode(startTime=start_s)
        for name, value in parameters.items():
            self.set(name, value)
        self.unit.exitInitializationMode()

    def close(self):
        self.unit.freeInstance()
        shutil.rmtree(self.folder, ignore_errors=True)

    def set(self, name, value):
        reference = self.variables[name].valueReference
        (self.unit.setReal if self.is_2 else self.unit.setFloat64)([reference], [value])

    def get(self, name):
        variable = self.variables[name]
        if self.is_2:
            get = self.unit.getReal if variable.type == "Real" else self.unit.getInteger
        else:
            by_type = {"Float64": "getFloat64", "Int32": "getInt32", "Enumeration": "getInt64"}
            get = getattr(self.unit, by_type[variable.type])
        return get([variable.valueReference])[0]

    def all(self):
        """Every output."""
        return {name: self.get(name) for name, of in self.variables.items() if of.causality == "output"}

    def word(self, name):
        """The word of an enumeration."""
        return self.variables[name].declaredType.items[self.get(name) - 1].name

    def step(self, from_s, step_s=STEP_S):
        return self.unit.doStep(from_s, step_s)


@pytest.fixture(params="23")
def version(request):
    return request.param


@pytest.fixture
def unit(archives, version):
    """Makes units that are closed at the end."""
    made = []

    def make(kind, **more):
        made.append(Unit(archives[kind, version], **more))
        return made[-1]

    yield make
    for one in made:
        one.close()


def inputs(step):
    """What a master sets of the plant for a step."""
    from math import sin

    return {
        "air_k": 280.0 + 10.0 * sin(step / 17.0),
        "wind_m_s": 2.0 + 1.5 * sin(step / 7.0),
        "irradiance_w_m2": 150.0 + 100.0 * sin(step / 23.0),
        "leak_kg_s": 2e-5 + 1e-5 * sin(step / 29.0),
    }


def scenario(steps):
    """The same as a scenario of the program: each value holds for a step."""
    times = [t for step in range(steps) for t in (STEP_S * step, STEP_S * (step + 1))]

    def held(name, column):
        values = [inputs(step)[name] for step in range(steps) for _ in range(2)]
        return f"{{ time_s = {times}, {column} = {values} }}"

    return f"""
name = "steps"
duration_s = {STEP_S * steps}
sample_time_s = {STEP_S}

[initial]
fill_pressure_bar = 200
fill_temperature_degc = 15
temperature_k = 275

[sun]

[ambient]
air_table = {held("air_k", "air_k")}
wind_table = {held("wind_m_s", "wind_m_s")}
irradiance_table = {held("irradiance_w_m2", "irradiance_w_m2")}

[[leak]]
name = "leak"
flow_table = {held("leak_kg_s", "flow_kg_s")}
""" + SENSORS
