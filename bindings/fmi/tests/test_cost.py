"""What a step costs; `bindings/fmi/test -s -k cost` prints it."""

import time
from math import sin

from conftest import READINGS, STEP_S, Unit


def per_step_ms(unit, steps, step_s, advance):
    begun = time.process_time()
    for step in range(steps):
        advance(step)
        unit.step(step_s * step, step_s)
        unit.get("mass_kg")
    return 1e3 * (time.process_time() - begun) / steps


def test_the_cost_of_a_step_and_the_size_of_an_archive(archives):
    # Bounds for any profile of the compiler: they end a step that has become another thing.
    for kind in ("plant", "monitor"):
        size = archives[kind, "2"].stat().st_size
        print(f"\n{kind}: {size} bytes")
        assert size < 20e6
    for step_s in (1.0, STEP_S, 3600.0):
        plant = Unit(archives["plant", "2"], wind_m_s=2.0)
        cost = per_step_ms(plant, 300, step_s, lambda step: plant.set("air_k", 280.0 + 5.0 * sin(step)))
        plant.close()
        print(f"plant, a step of {step_s:g} s: {cost:.2f} ms")
        assert cost < 50.0
    monitor = Unit(archives["monitor", "2"])

    def readings(step):
        for name, value in zip(READINGS, (288.15 + sin(step), 288.15 + sin(0.9 * step), 200e5 + 1e3 * sin(step))):
            monitor.set(name, value)

    cost = per_step_ms(monitor, 2000, STEP_S, readings)
    monitor.close()
    print(f"monitor, a row: {cost:.3f} ms")
    assert cost < 5.0
