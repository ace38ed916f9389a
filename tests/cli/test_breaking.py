"""`archgen diff --breaking`: what is shown, what the project's policy says, what was agreed."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema_rs
import pytest

from archgen import resources
from tests.cli.conftest import Run

ROBOT = """\
project: {id: robot}
partners: {certh: CERTH, sssa: SSSA}
groups:
  sensing:
    owner: certh
    components:
      camera: {outputs: {image: sensor_msgs/msg/Image}}
      lamp: {title: Lamp}
  display:
    owner: sssa
    components:
      screen: {title: Screen, inputs: {image: camera.image}}
"""
RETYPED = ROBOT.replace("sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage").replace("Lamp", "Torch")
SHOWN = """\
Breaking changes
  ~ breaks sssa: `sensing.camera.image` now carries `sensor_msgs/msg/CompressedImage` instead of `sensor_msgs/msg/Image`; \
it is read by `display.screen.image`
      gives sssa, who reads `sensing.camera.image` as `display.screen.image`, `sensor_msgs/msg/CompressedImage` instead of \
`sensor_msgs/msg/Image`
"""
STRICT = "review: {breaking: error}\n"
ENTRY = "sensing.camera.image"


@pytest.fixture
def both(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Give a folder for two versions."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def write(folder: Path, before: str, after: str) -> None:
    """Write both versions."""
    (folder / "a.yaml").write_text(before, encoding="utf-8")
    (folder / "b.yaml").write_text(after, encoding="utf-8")


def diff(run: Run, *words: str) -> tuple[int, str]:
    """Compare them, and give status and output."""
    ran = run("diff", "a.yaml", "b.yaml", *words)
    assert ran.err == ""
    return ran.status, ran.out


def test_only_what_breaks_somebody_and_why(run: Run, both: Path) -> None:
    write(both, ROBOT, RETYPED)
    assert diff(run, "--breaking") == (0, f"{SHOWN}\nwarning: 1 breaking change for sssa\n")
    status, whole = diff(run)
    assert (status, whole.startswith(SHOWN)) == (0, True)
    assert "title" in whole
    assert whole.endswith("; concerns certh, sssa; breaks sssa\n")


def test_nobody_is_broken(run: Run, both: Path) -> None:
    write(both, ROBOT + STRICT, ROBOT.replace("Lamp", "Torch") + STRICT)
    assert diff(run, "--breaking") == (0, "no change breaks another partner\n")


@pytest.mark.parametrize(("before", "after"), [("error", "error"), ("error", "off"), ("note", "error"), ("error", "")])
def test_the_stricter_policy_counts(run: Run, both: Path, before: str, after: str) -> None:
    write(both, ROBOT + f"review: {{breaking: {before}}}\n", RETYPED + f"review: {{breaking: {after}}}\n")
    status, out = diff(run, "--breaking")
    assert status == 1
    assert out.endswith(
        "\nerror: 1 breaking change for sssa; `review.breaking: error` refuses what is not accepted\n"
        "  = help: mend it, or agree on it and say why: `review: {accepted: {sensing.camera.image: THE REASON}}`\n"
    )
    assert diff(run)[0] == 0


@pytest.mark.parametrize(
    ("before", "after", "said"), [("note", "note", "note"), ("off", "note", "note"), ("off", "", "warning")]
)
def test_milder_policies_only_say_so(run: Run, both: Path, before: str, after: str, said: str) -> None:
    write(both, ROBOT + f"review: {{breaking: {before}}}\n", RETYPED + f"review: {{breaking: {after}}}\n")
    assert diff(run, "--breaking") == (0, f"{SHOWN}\n{said}: 1 breaking change for sssa\n")


def test_a_project_that_does_not_ask(run: Run, both: Path) -> None:
    off = "review: {breaking: off}\n"
    write(both, ROBOT + off, RETYPED + off)
    assert diff(run, "--breaking") == (
        0,
        "`review.breaking` is off: this project does not ask what breaks another partner\n",
    )
    assert "breaks" not in diff(run)[1]


def accepting(entries: str) -> str:
    """Give the section that accepts something."""
    return f"review: {{breaking: error, accepted: {{{entries}}}}}\n"


@pytest.mark.parametrize("entry", [f"{ENTRY}: agreed in March", f"{ENTRY}: {{reason: agreed in March, key: type}}"])
def test_what_is_accepted_is_shown_with_its_reason(run: Run, both: Path, entry: str) -> None:
    write(both, ROBOT + STRICT, RETYPED + accepting(entry))
    assert diff(run, "--breaking") == (
        0,
        f"{SHOWN}      accepted: agreed in March\n\n1 breaking change for sssa, accepted\n",
    )


def test_an_acceptance_from_before_is_called_so(run: Run, both: Path) -> None:
    write(both, ROBOT + accepting(f"{ENTRY}: agreed in March"), RETYPED + accepting(f"{ENTRY}: agreed in March"))
    assert diff(run, "--breaking") == (
        0,
        f"{SHOWN}      accepted (by an entry that was there before): agreed in March\n\n1 breaking change for sssa, accepted\n",
    )


def test_an_acceptance_that_the_change_takes_away_does_not_count(run: Run, both: Path) -> None:
    write(both, ROBOT + accepting(f"{ENTRY}: agreed in March"), RETYPED + STRICT)
    assert diff(run, "--breaking")[0] == 1


@pytest.mark.parametrize(
    ("entry", "said"),
    [
        (f"{ENTRY}: {{reason: why not, key: qos}}", " with the key `qos` (b.yaml:13:38) names no breaking change here"),
        ("sensing.camera: why not", " (b.yaml:13:38) names no breaking change here"),
        (
            "sensing.camra.image: why not",
            (
                " (b.yaml:13:38) names no breaking change here, and nothing in either version has this id; "
                "did you mean `sensing.camera.image`?"
            ),
        ),
    ],
)
def test_what_accepts_something_else_is_idle(run: Run, both: Path, entry: str, said: str) -> None:
    write(both, ROBOT, RETYPED + accepting(entry))
    status, out = diff(run, "--breaking")
    assert (status, out.splitlines()[-1]) == (1, f"note: accepted entry `{entry.partition(':')[0]}`{said}")


def test_json(run: Run, both: Path) -> None:
    write(both, ROBOT, RETYPED + accepting(f"{ENTRY}: {{reason: why not, key: qos}}"))
    status, out = diff(run, "--breaking", "--format", "json")
    data = json.loads(out)
    schema = json.loads(resources.resource_path("schemas", "diff.schema.json").read_text(encoding="utf-8"))
    assert [error.message for error in jsonschema_rs.validator_for(schema).iter_errors(data)] == []
    (change,) = data["changes"]
    assert (status, change["breaks"], change["accepted"]) == (1, ["sssa"], None)
    assert [(one["partner"], one["why"][:10]) for one in change["because"]] == [("sssa", "gives sssa")]
    assert data["breaking"] == {
        "severity": "error",
        "fails": True,
        "idle": [{"element": ENTRY, "key": "qos", "reason": "why not"}],
    }
    assert (data["findings"], data["chains"]) == ({"new": [], "cured": [], "silenced": []}, [])


def test_exit_code_counts_what_is_shown(run: Run, both: Path) -> None:
    write(both, ROBOT, ROBOT.replace("Lamp", "Torch"))
    assert diff(run, "--breaking", "--exit-code")[0] == 0
    write(both, ROBOT, RETYPED)
    assert diff(run, "--breaking", "--exit-code")[0] == 1


def test_reasons_from_strangers_move_no_terminal(run: Run, both: Path) -> None:
    evil = r'"\e[2J::error::x\u202e"'
    write(both, ROBOT, RETYPED + accepting(f"{ENTRY}: {evil}, {evil}: y"))
    for form in ("text", "json"):
        out = diff(run, "--breaking", "--format", form)[1]
        assert "\x1b" not in out
        assert "\u202e" not in out
        assert not any(line.lstrip().startswith("::") for line in out.splitlines())


def test_what_could_not_be_read_breaks_nobody(run: Run, both: Path) -> None:
    whole, rest = ROBOT.split("groups:")
    sensing, display = f"groups:{rest}".split("  display:")
    files = {
        "archgen.yaml": whole,
        "sensing.yaml": sensing,
        "display.yaml": f"groups:\n  display:{display}",
        "nodes.yaml": "nodes:\n  eye: {implements: camera, publishes: {image: /eye/image}}\n  screen: {implements: screen}\n",
    }
    for name, text in files.items():
        for side in ("old", "new"):
            (both / side).mkdir(exist_ok=True)
            (both / side / name).write_text(text, encoding="utf-8")
    for broken in ("sensing.yaml", "nodes.yaml"):
        (both / "new" / broken).write_text(f"{files[broken]}  x: [", encoding="utf-8")
        ran = run("diff", "old", "new", "--breaking")
        assert (ran.status, ran.out.splitlines()[0]) == (
            0,
            "new is not sound (1 error). What cannot be read there is left out of the comparison:",
        )
        assert ran.out.endswith("\nno change breaks another partner\n")
        (both / "new" / broken).write_text(files[broken].replace("/eye/image", "/eye/rgb"), encoding="utf-8")
    assert "breaks sssa: `eye.publishes.image`" in run("diff", "old", "new", "--breaking").out
