"""The first hour is done as it is written: each file, each mistake, each command with what it prints."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from archgen.diagnostics.diagnostic import Severity
from archgen.pipeline import check_project
from tests.repositories import commit, repository
from tests.running import ROOT, archgen_here

PAGE = (ROOT / "docs" / "first_hour.md").read_text(encoding="utf-8")
STEPS = re.findall(r"^## (\d\. [^\n]*)\n(.*?)(?=^## |\Z)", PAGE, re.MULTILINE | re.DOTALL)
BLOCK = re.compile(r"^```(\w+)\n(?:# (\S+)\n)?(.*?)^```$", re.MULTILINE | re.DOTALL)


def take_lines(body: str, sign: str) -> str:
    return "".join(f"{line[1:]}\n" for line in body.splitlines() if line.startswith(sign))


def assert_printed(shown: str, printed: str) -> None:
    """Assert that what is shown was printed, in order, with `...` for what is left out."""
    position = 0
    for part in re.split(r"^\.\.\.\n?", shown, flags=re.MULTILINE):
        position = printed.find(part, position)
        assert position >= 0, f"not printed (any more):\n{part}\n--- printed:\n{printed}"


class Hour:
    """The folder of somebody who does what the page says."""

    def __init__(self, top: Path) -> None:
        self.top = repository(top, {"README.md": "x\n"})
        self.planted: tuple[Path, str] | None = None

    def do_step(self, text: str) -> None:
        """Write, plant and run what a step shows; what was planted goes before the next file, and at the end."""
        for kind, name, body in BLOCK.findall(text):
            if kind == "console":
                self.run(body)
                continue
            self.take_back()
            file = self.top / name
            if kind == "yaml":
                file.parent.mkdir(exist_ok=True)
                file.write_text(body, encoding="utf-8")
            else:
                assert kind == "diff"
                if "git commit" in text:
                    commit(self.top, {})
                before = file.read_text(encoding="utf-8")
                assert before.count(take_lines(body, "-")) == 1
                file.write_text(before.replace(take_lines(body, "-"), take_lines(body, "+")), encoding="utf-8")
                self.planted = file, before
        self.take_back()

    def take_back(self) -> None:
        """Change a planted mistake back."""
        if self.planted:
            self.planted[0].write_text(self.planted[1], encoding="utf-8")
            self.planted = None

    def run(self, body: str) -> None:
        """Run the commands of a block; an error ends them with 1."""
        for words, shown in re.findall(r"^\$ archgen ([^\n]*)\n(.*?)(?=^\$ |\Z)", body, re.MULTILINE | re.DOTALL):
            status = int(self.planted is not None and "error[" in shown)
            assert_printed(shown, archgen_here(*words.split(), cwd=self.top, status=status).stdout.decode())


def test_there_are_eight_steps_and_each_plants_a_mistake() -> None:
    assert [title[0] for title, _ in STEPS] == list("12345678")
    assert all([kind for kind, _, _ in BLOCK.findall(text)].count("diff") == 1 for _, text in STEPS)
    assert PAGE.count("```") == 2 * sum(len(BLOCK.findall(text)) for _, text in STEPS)


def test_all_of_it_happens_as_it_is_written(tmp_path: Path) -> None:
    hour = Hour(tmp_path / "museum")
    for _, text in STEPS:
        hour.do_step(text)
    for project in ("guide", "transporter"):
        findings = check_project(hour.top / project).findings
        assert [each.message for each in findings if each.effective_severity > Severity.NOTE] == []
    assert len(check_project(hour.top / "guide").architecture.components) == 3


def test_what_is_not_printed_is_told() -> None:
    assert_printed("a\n...\nc\n", "a\nb\nc\n")
    with pytest.raises(AssertionError):
        assert_printed("a\nc\n", "a\nb\nc\n")
    with pytest.raises(AssertionError):
        assert_printed("c\n...\na\n", "a\nb\nc\n")
