"""What is shown while somebody types: quick findings, and those that lag."""

from __future__ import annotations

from pathlib import Path

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.live.warm_project import WarmProject, join_quick_findings, keep_waiting_findings

ROBOT = """\
archgen: 1
hosts: {pc: {cores: 1}}
groups:
  g:
    components:
      eye: {outputs: {o: std_msgs/msg/Bool, spare: std_msgs/msg/Bool}}
      brake: {inputs: {i: eye.o}}
nodes:
  eye: {implements: eye, host: pc, timing: {period: 100 ms, wcet: 50 ms, bcet: 5 ms, priority: 3}}
  brake: {implements: brake, host: pc, timing: {behaviour: event, wcet: 50 ms, bcet: 5 ms}}
chains:
  stop: {through: [g.eye, g.brake], deadline: 20 ms}
variants:
  blind:
    changes: {groups: {g: {components: {brake: {inputs: {j: g.eye.spare}}}}}}
"""
NOWHERE = ("", 0)


class Typing:
    """A project of one file, with what is shown of it."""

    def __init__(self, folder: Path) -> None:
        """Check it once, at rest."""
        (folder / "archgen.yaml").write_text(ROBOT, encoding="utf-8")
        self.project = WarmProject(folder)
        self.checked = self.project.check()
        self.shown = self.checked.findings

    def write(self, text: str, cursor: tuple[str, int] = NOWHERE) -> tuple[Diagnostic, ...]:
        """Check another text in haste."""
        self.project.set_text("archgen.yaml", text)
        checked = self.project.check((), has_timing=False)
        self.shown = join_quick_findings(checked, self.shown, self.checked.sources, cursor)
        self.checked = checked
        return self.shown


def test_a_quick_check_shows_what_a_whole_one_does(tmp_path: Path) -> None:
    typing = Typing(tmp_path)
    assert "late-chain" in {finding.rule for finding in typing.shown}
    assert any(finding.variants for finding in typing.shown)
    assert typing.write(f"{ROBOT}# more\n") == typing.project.check().findings


def test_findings_that_lag_move_with_their_lines(tmp_path: Path) -> None:
    typing = Typing(tmp_path)
    lines = {finding.rule: finding.span.line for finding in typing.shown}
    shown = typing.write(ROBOT.replace("groups:", "# a\n# b\ngroups:", 1))
    assert next(finding for finding in shown if finding.rule == "late-chain").span.line == lines["late-chain"] + 2
    assert shown == typing.project.check().findings


def test_a_finding_of_lines_that_are_gone_goes(tmp_path: Path) -> None:
    typing = Typing(tmp_path)
    shown = typing.write(ROBOT.replace("chains:\n  stop: {through: [g.eye, g.brake], deadline: 20 ms}\n", ""))
    assert "late-chain" not in {finding.rule for finding in shown}


def test_half_a_word_is_no_slip_yet(tmp_path: Path) -> None:
    typing = Typing(tmp_path)
    text = ROBOT.replace("i: eye.o}", "i: eye.}")
    assert "wrong-value" not in {each.rule for each in typing.write(text, ("archgen.yaml", 7))}
    assert "wrong-value" in {each.rule for each in typing.write(text)}


def test_one_slip_does_not_empty_the_list_of_problems(tmp_path: Path) -> None:
    typing = Typing(tmp_path)
    before = {finding.rule for finding in typing.shown}
    text = ROBOT.replace("i: eye.o}", "i: eye.wrong}")
    assert before <= {finding.rule for finding in typing.write(text)}
    whole = typing.project.check()
    assert "late-chain" not in {finding.rule for finding in whole.findings}
    assert "late-chain" in {each.rule for each in keep_waiting_findings(whole, typing.shown, typing.checked.sources)}
    assert keep_waiting_findings(typing.project.check(), (), typing.checked.sources) == whole.findings
