"""Virtual environment with the peers, and what machine this is."""

import os
import platform
import re
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).parent
ROOT = HERE.parent.parent
VENV = ROOT / "target" / "peers-venv"


def python() -> Path:
    """Interpreter of the virtual environment."""
    return VENV / ("Scripts/python.exe" if os.name == "nt" else "bin/python")


def requirements() -> dict[str, str]:
    """Pinned version of each peer."""
    lines = (HERE / "requirements.txt").read_text(encoding="utf-8").splitlines()
    return dict(line.split("==") for line in lines if line and not line.startswith("#"))


def installed() -> dict[str, str]:
    """Versions of what the environment holds."""
    code = "from importlib.metadata import distributions as d\nfor p in d(): print(p.name, p.version)"
    done = subprocess.run([python(), "-c", code], capture_output=True, text=True, check=True)
    pairs = (line.split() for line in done.stdout.splitlines())
    return {re.sub("[-_.]+", "-", name).lower(): version for name, version in pairs}


def prepare() -> dict[str, str]:
    """Make the environment; the reason for each peer that is not there."""
    if not python().exists():
        subprocess.run([sys.executable, "-m", "venv", VENV], check=True)
    missing = {}
    for name, version in requirements().items():
        if installed().get(name.lower()) == version:
            continue
        print(f"installing {name} {version}", file=sys.stderr)
        pip: list[str | Path] = [python(), "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
        done = subprocess.run([*pip, f"{name}=={version}"], capture_output=True, text=True, check=False)
        if done.returncode:
            reason = (done.stderr.strip().splitlines() or ["pip failed"])[-1]
            missing[name] = "not installed"
            print(f"skipped: {name} {version} ({reason})", file=sys.stderr)
    return missing


def build() -> Path:
    """Build this project's side; its program."""
    subprocess.run(["cargo", "build", "--release", "--example", "peers"], cwd=ROOT, check=True)
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    return target / "release" / "examples" / ("peers.exe" if os.name == "nt" else "peers")


def output(command: list[str]) -> str:
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()


def machine() -> dict[str, str]:
    """Processor, cores, operating system and compilers; nothing that names the machine."""
    cpu = platform.processor() or platform.machine()
    info = Path("/proc/cpuinfo")
    if info.exists():
        found = re.search(r"model name\s*: (.*)", info.read_text(encoding="utf-8"))
        cpu = found[1].strip() if found else cpu
    try:
        system = platform.freedesktop_os_release()["PRETTY_NAME"]
    except OSError:
        system = platform.platform(terse=True)
    return {
        "cpu": cpu,
        "cores": str(os.cpu_count()),
        "system": system,
        "python": platform.python_version(),
        "rustc": output(["rustc", "--version"]).split(" (")[0],
    }


def load() -> float:
    """Mean number of running programs over the last minute; not a number where the system does not say."""
    return os.getloadavg()[0] if hasattr(os, "getloadavg") else float("nan")
