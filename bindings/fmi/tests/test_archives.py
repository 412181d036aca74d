"""What is in an archive, and what is damaged."""

import shutil
import subprocess
import sys
import zipfile

import fmpy
import pytest
from conftest import Unit
from fmpy.validation import validate_fmu


@pytest.mark.parametrize("kind", ["plant", "monitor"])
def test_fmpy_finds_nothing_to_say(archives, kind, version):
    path = archives[kind, version]
    assert validate_fmu(str(path)) == []
    command = [sys.executable, "-m", "fmpy", "validate", str(path)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0 and "No problems found" in done.stdout + done.stderr, done.stdout + done.stderr


def test_every_number_has_its_unit(archives, version):
    for kind in ("plant", "monitor"):
        description = fmpy.read_model_description(str(archives[kind, version]))
        for variable in description.modelVariables:
            assert variable.description
            if variable.type in ("Real", "Float64"):
                assert variable.unit in {unit.name for unit in description.unitDefinitions}, variable.name


def damaged(path, folder, change):
    """The archive, extracted, with another resource."""
    unpacked = fmpy.extract(str(path), unzipdir=str(folder / "unpacked"))
    resource = folder / "unpacked" / "resources" / "cylinder.bin"
    resource.write_bytes(change(resource.read_bytes()))
    return unpacked


def flipped(at):
    return lambda bytes_: bytes_[:at] + bytes([bytes_[at] ^ 4]) + bytes_[at + 1 :]


@pytest.mark.parametrize("kind", ["plant", "monitor"])
@pytest.mark.parametrize("change", [flipped(200), flipped(-1), flipped(9), lambda bytes_: bytes_[:100], lambda _: b""])
def test_a_damaged_resource_is_refused(archives, kind, version, tmp_path, change):
    path = archives[kind, version]
    folder = damaged(path, tmp_path, lambda bytes_: change(bytes_))
    with pytest.raises(Exception):
        Unit(path, folder=folder)


def test_a_resource_of_another_archive_is_refused(archives, version, tmp_path):
    path = archives["plant", version]
    with zipfile.ZipFile(archives["monitor", version]) as other:
        foreign = other.read("resources/cylinder.bin")
    with pytest.raises(Exception):
        Unit(path, folder=damaged(path, tmp_path, lambda _: foreign))


def test_without_a_resource_there_is_no_unit(archives, version, tmp_path):
    path = archives["plant", version]
    folder = fmpy.extract(str(path), unzipdir=str(tmp_path / "unpacked"))
    (tmp_path / "unpacked" / "resources" / "cylinder.bin").unlink()
    with pytest.raises(Exception):
        Unit(path, folder=folder)


def test_a_damaged_archive_does_not_open(archives, version, tmp_path):
    path = tmp_path / "damaged.fmu"
    bytes_ = archives["plant", version].read_bytes()
    path.write_bytes(bytes_[: len(bytes_) // 2] + b"something else" + bytes_[len(bytes_) // 2 + 14 :])
    with pytest.raises(Exception):
        fmpy.extract(str(path), unzipdir=str(tmp_path / "unpacked"))
    path.write_bytes(bytes_[: len(bytes_) // 2])
    with pytest.raises(Exception):
        fmpy.read_model_description(str(path))


def test_a_path_with_blanks_and_umlauts_is_found(archives, version, tmp_path):
    place = tmp_path / "mit Leer zeichen und Ümlaut%20"
    shutil.copy(archives["monitor", version], tmp_path / "monitor.fmu")
    unit = Unit(tmp_path / "monitor.fmu", folder=fmpy.extract(str(tmp_path / "monitor.fmu"), unzipdir=str(place)))
    assert unit.word("verdict") == "unknown"
    unit.close()
