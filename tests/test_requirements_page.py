"""The page on requirements: its example is a project in which nothing is wrong, and says what the page says."""

from __future__ import annotations

import re
from pathlib import Path

from archgen.diagnostics.diagnostic import Severity
from archgen.pipeline import check_project
from archgen.views.lookup import make_lookup
from archgen.views.timing.timing_lookup import analyse_with_chains
from tests.running import ROOT

PAGE = (ROOT / "docs" / "requirements.md").read_text(encoding="utf-8")


def test_the_example_of_the_page_is_sound_and_its_requirements_are_judged(tmp_path: Path) -> None:
    (example,) = re.findall(r"^```yaml\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    (tmp_path / "robot.yaml").write_text(example, encoding="utf-8")
    checked = check_project(tmp_path / "robot.yaml")
    assert [str(each) for each in checked.findings if each.effective_severity > Severity.NOTE] == []
    lookup = make_lookup(checked.architecture, timing_lookup=analyse_with_chains(checked.architecture))
    states = {name: lookup.requirement_trace.judge(name) for name in checked.architecture.requirements}
    assert states == {"R-1": "met", "R-1.1": "met", "R-1.2": "met", "R-2": "met"}


def test_the_page_explains_every_key_of_a_requirement_and_every_state() -> None:
    from archgen.schema.language_schema import load_schema

    keys = load_schema()["$defs"]["requirement"]["properties"]
    first_cells = " ".join(re.findall(r"^\| ([^|]*) \|", PAGE, re.MULTILINE))
    assert [key for key in keys if f"`{key}`" not in first_cells] == []
    assert [state for state in ("uncovered", "missed", "open", "met") if f"`{state}`" not in first_cells] == []
