#!/usr/bin/env python3
"""Measure `cylwatch fleet`: rows a second with one thread and with two, memory, and bytes after kills.

`cargo build --release && benches/fleet.py` makes a fleet of copies of four simulated cylinders, one of which leaks 3 g/h, runs it with
each number of threads, then kills it again and again at random moments, resumes it, and compares all files. Needs Python 3.11 and Linux.
"""

import argparse
import hashlib
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
WEEK = ROOT / "scenarios" / "railway-week.csv"
LEAK = '[[leak]]\nname = "leak"\nflow_g_h = 3\nstart_h = 12\n\n[limits]'
OPTIONS = ["--vessel", "nitrogen-20l", "--fill-pressure-bar", "200", "--fill-temperature-degc", "15", "--format", "csv"]


def simulated(program: Path, folder: Path, days: float, kind: int) -> tuple[str, list[str]]:
    """Header and rows of a log: the week of the built-in scenario, over and over."""
    header, *rows = [line for line in WEEK.read_text().splitlines() if not line.startswith("#")]
    weeks, table = 1 + int(days / 7), [header]
    for week in range(weeks):
        for row in rows[week > 0 :]:
            second, rest = row.split(",", 1)
            table.append(f"{float(second) + week * 7 * 86400:g},{rest}")
    (folder / "railway-week.csv").write_text("\n".join(table) + "\n")
    text = WEEK.with_suffix(".toml").read_text().replace("duration_d = 7", f"duration_d = {days}")
    (folder / "scenario.toml").write_text(text.replace("[limits]", LEAK) if kind == 3 else text)
    subprocess.run(
        [program, "simulate", "nitrogen-20l", "scenario.toml", "-o", "run.csv", "--seed", str(kind), "-q"], cwd=folder, check=True
    )
    lines = [line for line in (folder / "run.csv").read_text().splitlines() if not line.startswith("#")]
    names = lines[0].split(",")
    kept = [k for k, name in enumerate(names) if name == "time_s" or name.startswith("measured_")]
    cut = [",".join(line.split(",")[k] for k in kept) for line in lines]
    return cut[0].replace("measured_", ""), cut[1:]


def write_logs(program: Path, folder: Path, cylinders: int, days: float, together: bool) -> int:
    """Writes the logs, a file each or all in one; the number of rows."""
    logs = folder / "logs"
    logs.mkdir()
    kinds = [simulated(program, folder, days, kind) for kind in range(4)]
    names = [f"N{k:05d}" for k in range(cylinders)]
    if together:
        with open(logs / "site.csv", "w") as file:
            file.write(f"{kinds[0][0]},cylinder\n")
            for at in range(len(kinds[0][1])):
                file.writelines(f"{kinds[k % 4][1][at]},{name}\n" for k, name in enumerate(names))
    else:
        texts = ["\n".join([header, *rows]) + "\n" for header, rows in kinds]
        for k, name in enumerate(names):
            (logs / f"{name}.csv").write_text(texts[k % 4])
    return sum(len(kinds[k % 4][1]) for k in range(cylinders))


def started(program: Path, folder: Path, threads: int) -> subprocess.Popen:
    command = [program, "fleet", "logs", *OPTIONS, "-o", "out", "--threads", str(threads), "-q"]
    return subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL)


def ended(run: subprocess.Popen, begun: float) -> tuple[float, float, float]:
    """Wall time and CPU time, s, and largest memory, MB, of a run that must come to its end."""
    memory, waited = 0.0, (0, 0, None)
    while not waited[0]:
        # What the system keeps for the parent counts this program's memory, too.
        found = re.search(r"VmHWM:\s+(\d+)", Path(f"/proc/{run.pid}/status").read_text())
        memory = max(memory, int(found[1]) / 1024 if found else 0)
        time.sleep(0.02)
        waited = os.wait4(run.pid, os.WNOHANG)
    _, status, usage = waited
    wall = time.monotonic() - begun
    run.returncode = os.waitstatus_to_exitcode(status)
    if run.returncode not in (0, 1, 3):
        sys.exit(f"the run ended with {run.returncode}")
    return wall, usage.ru_utime + usage.ru_stime, memory


def content(folder: Path) -> dict[str, str]:
    """Hashes of all files of the output that are not hidden."""
    files = [path for path in (folder / "out").rglob("*") if path.is_file() and not path.name.startswith(".")]
    return {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest() for path in files}


def killed(program: Path, folder: Path, kills: int, wall_s: float, draw: random.Random) -> None:
    """Kills runs at random, some twenty on the way of each from nothing to its end, and compares what they leave."""
    expected, done, lines = content(folder), 0, 0
    while done < kills:
        shutil.rmtree(folder / "out", ignore_errors=True)
        lines += 1
        while done < kills:
            run = started(program, folder, 2)
            time.sleep(draw.uniform(0, 2 * wall_s / 20))
            if run.poll() is not None:
                break
            run.send_signal(signal.SIGKILL)
            run.wait()
            done += 1
        ended(started(program, folder, 2), time.monotonic())
        found = content(folder)
        if found != expected:
            other = sorted(name for name in found.keys() | expected.keys() if found.get(name) != expected.get(name))
            sys.exit(f"after {done} kills other bytes: {', '.join(other[:9])}")
    print(f"killed {done} times, begun anew {lines - 1} times: all {len(expected)} files have the same bytes")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cylinders", type=int, default=60)
    parser.add_argument("--days", type=float, default=3)
    parser.add_argument("--threads", type=int, nargs="+", default=[1, 2], help="threads of each run [1 2]")
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1, help="of the moments of the kills")
    parser.add_argument("--together", action="store_true", help="all cylinders in one log with a column `cylinder`")
    parser.add_argument("--rows", action="store_true", help="write the rows of each cylinder, too")
    parser.add_argument("--program", type=Path, default=ROOT / "target" / "release" / "cylwatch")
    parser.add_argument("--folder", type=Path, help="where the fleet is made [the system's place for temporary files]")
    given = parser.parse_args()
    program = given.program.resolve()
    OPTIONS.extend(["--rows"] if given.rows else [])
    with tempfile.TemporaryDirectory(dir=given.folder, prefix="cylwatch-fleet-") as name:
        folder = Path(name)
        rows = write_logs(program, folder, given.cylinders, given.days, given.together)
        size = sum(path.stat().st_size for path in (folder / "logs").iterdir()) / 1e6
        print(f"{given.cylinders} cylinders of {given.days:g} d, {rows} rows, {size:.0f} MB of logs", flush=True)
        walls, first = {}, None
        for threads in given.threads:
            shutil.rmtree(folder / "out", ignore_errors=True)
            begun = time.monotonic()
            wall, cpu, memory = ended(started(program, folder, threads), begun)
            walls[threads] = wall
            speeds = f"{rows / wall:.0f} rows/s; CPU {cpu:.1f} s, {rows / cpu:.0f} rows/s"
            print(f"{threads} threads: {wall:.1f} s, {speeds}; {memory:.0f} MB", flush=True)
            first = first or content(folder)
            if content(folder) != first:
                sys.exit("the number of threads changes bytes")
        if len(walls) > 1:
            few, many = min(walls), max(walls)
            print(f"{many} threads are {walls[few] / walls[many]:.2f} times {few}", flush=True)
        if given.kills:
            killed(program, folder, given.kills, min(walls.values()), random.Random(given.seed))


main()
