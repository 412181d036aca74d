"""The Python of the book and the README runs."""

import re

import pytest
from conftest import ROOT


def blocks(page):
    return re.findall(r"```python\n(.*?)```", (ROOT / page).read_text(), re.DOTALL)


@pytest.mark.parametrize(
    "page, count", [("book/src/python.md", 3), ("book/src/coming-from.md", 3), ("README.md", 1), ("book/src/fleet.md", 1)]
)
def test_the_blocks_of_a_page_run(page, count, leak, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    found = blocks(page)
    assert len(found) == count
    for block in found:
        exec(compile(block, page, "exec"), {"frame": leak})
    said = capsys.readouterr().out
    assert "leak" in said
