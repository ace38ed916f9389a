"""The page on use cases: its example is a project without a finding above notes, in which every step can happen."""

from __future__ import annotations

import re
from pathlib import Path

from archgen.diagnostics.diagnostic import Severity
from archgen.model.step_connections import UseCaseSteps
from archgen.pipeline import check_project
from tests.running import ROOT

PAGE = (ROOT / "docs" / "use_cases.md").read_text(encoding="utf-8")
EXAMPLES = re.findall(r"^```yaml\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)


def test_every_step_of_the_example_can_happen(tmp_path: Path) -> None:
    (example,) = EXAMPLES
    (tmp_path / "archgen.yaml").write_text(example, encoding="utf-8")
    checked = check_project(tmp_path)
    assert [each for each in checked.findings if each.effective_severity > Severity.NOTE] == []
    ways = [each.way for each in UseCaseSteps(checked.architecture).by_use_case["UC-1"]]
    assert ways == ["outside", "topic", "service", "service", None, "topic", "outside"]
