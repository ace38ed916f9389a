"""`archgen diff --breaking`: what is shown, what the project's policy says, what was agreed."""

from __future__ import annotations

import json
import shutil
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
  ~ breaks SSSA (wire): `sensing.camera.image` of CERTH now carries `sensor_msgs/msg/CompressedImage` instead of `sensor_msgs/msg/Image`; \
it is read by `display.screen.image`
      gives `sensor_msgs/msg/CompressedImage` instead of `sensor_msgs/msg/Image` as `sensing.camera.image`; \
`display.screen.image` of SSSA reads it
"""
MISSING = """\
      # review/sssa.yaml
      review:
        accepted:
          sensing.camera.image: {key: type, was: a8601b, reason: THE REASON}
"""
STRICT = "review: {breaking: error}\n"
ENTRY = "sensing.camera.image"


@pytest.fixture
def both(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Give a folder for two versions."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def write(folder: Path, before: str, after: str, *agreements: str, old_agreements: tuple[str, ...] = ()) -> None:
    """Write both versions; an agreement is a file and what it accepts: `review/sssa.yaml: ...`."""
    for side, text, said in (("a", before, old_agreements), ("b", after, agreements)):
        shutil.rmtree(folder / side, ignore_errors=True)
        (folder / side / "review").mkdir(parents=True)
        (folder / side / "archgen.yaml").write_text(text, encoding="utf-8")
        for agreement in said:
            file, _, entries = agreement.partition(": ")
            (folder / side / file).write_text(f"review: {{accepted: {{{entries}}}}}\n", encoding="utf-8")


def diff(run: Run, *words: str) -> tuple[int, str]:
    """Compare them, and give status and output."""
    ran = run("diff", "./a", "./b", *words)
    assert ran.err == ""
    return ran.status, ran.out


def test_only_what_breaks_somebody_and_why(run: Run, both: Path) -> None:
    write(both, ROBOT, RETYPED)
    assert diff(run, "--breaking") == (0, f"{SHOWN}\nwarning: 1 breaking change for SSSA (wire)\n")
    status, whole = diff(run)
    assert (status, whole.startswith(SHOWN)) == (0, True)
    assert "title" in whole
    assert whole.endswith("; concerns CERTH, SSSA; breaks SSSA\n")


def test_nobody_is_broken(run: Run, both: Path) -> None:
    write(both, ROBOT + STRICT, ROBOT.replace("Lamp", "Torch") + STRICT)
    assert diff(run, "--breaking") == (0, "no change breaks another partner\n")


@pytest.mark.parametrize(("before", "after"), [("error", "error"), ("error", "off"), ("note", "error"), ("error", "")])
def test_the_stricter_policy_counts(run: Run, both: Path, before: str, after: str) -> None:
    write(both, ROBOT + f"review: {{breaking: {before}}}\n", RETYPED + f"review: {{breaking: {after}}}\n")
    status, out = diff(run, "--breaking")
    assert status == 1
    assert out.endswith(
        "\nerror: 1 breaking change for SSSA (wire); `review.breaking: error` refuses what is not accepted\n"
        f"  = help: mend it, or SSSA says why it is right:\n{MISSING}"
    )
    assert diff(run)[0] == 0


@pytest.mark.parametrize(
    ("before", "after", "said"), [("note", "note", "note"), ("off", "note", "note"), ("off", "", "warning")]
)
def test_milder_policies_only_say_so(run: Run, both: Path, before: str, after: str, said: str) -> None:
    write(both, ROBOT + f"review: {{breaking: {before}}}\n", RETYPED + f"review: {{breaking: {after}}}\n")
    assert diff(run, "--breaking") == (0, f"{SHOWN}\n{said}: 1 breaking change for SSSA (wire)\n")


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


AGREED = "{key: type, was: a8601b, reason: agreed in March}"
REFUSED = """
error: 1 breaking change for SSSA (wire); `review.breaking: error` refuses what is not accepted
  = help: mend it, or SSSA says why it is right:
"""
REFUSED += MISSING


def test_what_the_partner_accepts_in_its_own_file_is_shown_with_its_reason(run: Run, both: Path) -> None:
    write(both, ROBOT + STRICT, RETYPED + STRICT, f"review/sssa.yaml: {ENTRY}: {AGREED}")
    assert diff(run, "--breaking") == (
        0,
        f"{SHOWN}      accepted by SSSA: agreed in March\n\n1 breaking change for SSSA (wire), accepted\n",
    )


@pytest.mark.parametrize(
    ("agreement", "said"),
    [
        (f"review/certh.yaml: {ENTRY}: {AGREED}", "said in `review/certh.yaml`, not by SSSA: agreed in March"),
        (f"agreements.yaml: {ENTRY}: {AGREED}", "said in `agreements.yaml`, not by SSSA: agreed in March"),
        (
            f"review/sssa.yaml: {ENTRY}: 'agreed: in March'",
            (
                "said in `review/sssa.yaml` without a `key`, which would accept whatever changes: write "
                '`review: {accepted: {sensing.camera.image: {key: type, was: a8601b, reason: "agreed: in March"}}}`'
            ),
        ),
    ],
)
def test_what_the_partner_does_not_say_of_this_change_accepts_nothing(
    run: Run, both: Path, agreement: str, said: str
) -> None:
    write(both, ROBOT + STRICT, RETYPED + STRICT, agreement)
    assert diff(run, "--breaking") == (1, f"{SHOWN}      {said}\n{REFUSED}")
    mild = STRICT.replace("error", "warning")
    write(both, ROBOT + mild, RETYPED + mild, agreement)
    assert diff(run, "--breaking") == (0, f"{SHOWN}      {said}\n\nwarning: 1 breaking change for SSSA (wire)\n")


def test_an_acceptance_from_before_was_of_another_change(run: Run, both: Path) -> None:
    agreement = f"review/sssa.yaml: {ENTRY}: {AGREED}"
    write(both, ROBOT + STRICT, RETYPED + STRICT, agreement, old_agreements=(agreement,))
    said = "said in `review/sssa.yaml` before this change, of another one: agreed in March"
    assert diff(run, "--breaking") == (1, f"{SHOWN}      {said}\n{REFUSED}")
    again = agreement.replace("March", "May")
    write(both, ROBOT + STRICT, RETYPED + STRICT, again, old_agreements=(agreement,))
    assert diff(run, "--breaking")[0] == 0


def test_a_partner_that_the_change_renames_agrees_in_the_file_that_it_had(run: Run, both: Path) -> None:
    renamed = RETYPED.replace("sssa", "scuola")
    write(both, ROBOT + STRICT, renamed + STRICT, f"review/scuola.yaml: {ENTRY}: {AGREED}")
    assert diff(run, "--breaking")[0] == 1
    write(both, ROBOT + STRICT, renamed + STRICT, f"review/sssa.yaml: {ENTRY}: {AGREED}")
    assert diff(run, "--breaking")[0] == 0


def test_everybody_who_loses_something_has_to_agree(run: Run, both: Path) -> None:
    three = "  show: {owner: tum, components: {wall: {title: Wall, inputs: {image: camera.image}}}}\n"
    tum = "SSSA, tum: TUM}"
    before, after = (text.replace("SSSA}", tum) + three + STRICT for text in (ROBOT, RETYPED))
    agreement = f"review/sssa.yaml: {ENTRY}: {AGREED}"
    write(both, before, after, agreement)
    status, out = diff(run, "--breaking")
    assert (status, "      accepted by SSSA: agreed in March\n" in out) == (1, True)
    assert "mend it, or TUM says why it is right:\n      # review/tum.yaml\n" in out
    write(both, before, after, agreement, agreement.replace("sssa", "tum"))
    assert diff(run, "--breaking")[0] == 0


def test_all_that_is_refused_is_accepted_by_the_entries_of_the_help_line(run: Run, both: Path) -> None:
    three = (
        "  show: {owner: tum, components: {wall: {title: Wall, inputs: {image: camera.image, more: camera.depth}}}}\n"
    )
    before = ROBOT.replace("SSSA}", "SSSA, tum: TUM}").replace("outputs: {image:", "outputs: {depth: Depth, image:")
    before += three + STRICT
    after = before.replace("msg/Image", "msg/CompressedImage").replace("depth: Depth, ", "")
    write(both, before, after)
    status, out = diff(run, "--breaking")
    assert status == 1
    _, _, entries = out.partition("each say why it is right:\n")
    assert (
        entries
        == """\
      # review/sssa.yaml
      review:
        accepted:
          sensing.camera.image: {key: type, was: a8601b, reason: THE REASON}
      # review/tum.yaml
      review:
        accepted:
          sensing.camera.depth: {key: removed, was: "1e0eca", reason: THE REASON}
          sensing.camera.image: {key: type, was: a8601b, reason: THE REASON}
"""
    )
    for block in entries.split("      # ")[1:]:
        file, _, text = block.partition("\n")
        (both / "b" / file).write_text(text, encoding="utf-8")
    assert diff(run, "--breaking")[0] == 0


def test_an_entry_of_this_element_with_another_key_is_told_with_the_change(run: Run, both: Path) -> None:
    entry = f"review/sssa.yaml: {ENTRY}: {{key: qos, reason: best effort will do}}"
    write(both, ROBOT + STRICT, RETYPED + STRICT, entry)
    told = "      what `review/sssa.yaml` accepts is `qos`, and breaks nobody here; what breaks is `type`\n"
    assert told in diff(run)[1]
    # What was said of an earlier change is history.
    write(both, ROBOT + STRICT, RETYPED + STRICT, entry, old_agreements=(entry,))
    assert "what breaks is" not in diff(run)[1]


def test_an_edit_of_what_belongs_to_somebody_else_says_so(run: Run, both: Path) -> None:
    nodes = "nodes:\n  eye: {implements: camera}\n  mind: {implements: screen, subscribes: {image: {qos: reliable}}}\n"
    write(both, ROBOT + nodes.replace("reliable", "{depth: 5}"), ROBOT + nodes.replace("reliable", "{depth: 9}"))
    assert "Nodes\n  ~ `mind.subscribes.image` of SSSA: QoS depth 5 → 9\n" in diff(run)[1]
    eye = "      camera: {title: Eye, outputs: {image: sensor_msgs/msg/Image}}\n"
    titled = ROBOT.replace("      camera: {outputs: {image: sensor_msgs/msg/Image}}\n", eye)
    write(both, titled, titled.replace(eye, ""))
    assert "component `sensing.camera` (Eye) of CERTH is removed with 1 output" in diff(run)[1]
    alone = ROBOT.replace(", sssa: SSSA", "").replace("owner: sssa", "owner: certh") + nodes
    write(both, alone.replace("reliable", "{depth: 5}"), alone.replace("reliable", "{depth: 9}"))
    assert "Nodes\n  ~ `mind.subscribes.image`: QoS depth 5 → 9\n" in diff(run)[1]


def test_one_element_may_have_several_changes_that_are_accepted(run: Run, both: Path) -> None:
    entries = f"{ENTRY}: [{{key: qos, reason: other}}, {AGREED}]"
    write(both, ROBOT + STRICT, RETYPED + STRICT, f"review/sssa.yaml: {entries}")
    status, out = diff(run, "--breaking")
    assert status == 0
    assert out.endswith(
        "\nnote: accepted entry `sensing.camera.image` with the key `qos` (review/sssa.yaml:1:44) names no breaking change here\n"
    )


def test_what_is_removed_is_accepted_by_this_word(run: Run, both: Path) -> None:
    gone = ROBOT.replace("outputs: {image: sensor_msgs/msg/Image}", "title: Camera").replace("camera.image", "")
    removal = f"review/sssa.yaml: {ENTRY}: {{key: removed, reason: agreed}}"
    write(both, ROBOT + STRICT, gone + STRICT, removal)
    assert diff(run, "--breaking")[0] == 0
    write(both, ROBOT + STRICT, gone + STRICT, removal.replace("removed", "type"))
    assert diff(run, "--breaking")[0] == 1


def test_an_acceptance_that_the_change_takes_away_does_not_count(run: Run, both: Path) -> None:
    write(both, ROBOT + STRICT, RETYPED + STRICT, old_agreements=(f"review/sssa.yaml: {ENTRY}: {AGREED}",))
    assert diff(run, "--breaking")[0] == 1


@pytest.mark.parametrize(
    ("entry", "said"),
    [
        (
            f"{ENTRY}: {{reason: why not, key: qos}}",
            " with the key `qos` (review/sssa.yaml:1:21) names no breaking change here",
        ),
        ("sensing.camera: why not", " (review/sssa.yaml:1:21) names no breaking change here"),
        (
            "sensing.camra.image: why not",
            (
                " (review/sssa.yaml:1:21) names no breaking change here, and nothing in either version has this id; "
                "did you mean `sensing.camera.image`?"
            ),
        ),
    ],
)
def test_what_accepts_something_else_is_idle(run: Run, both: Path, entry: str, said: str) -> None:
    write(both, ROBOT, RETYPED + STRICT, f"review/sssa.yaml: {entry}")
    status, out = diff(run, "--breaking")
    assert (status, out.splitlines()[-1]) == (1, f"note: accepted entry `{entry.partition(':')[0]}`{said}")


def test_json(run: Run, both: Path) -> None:
    write(
        both,
        ROBOT,
        RETYPED + STRICT,
        f"review/sssa.yaml: {ENTRY}: {{reason: why not, key: qos}}",
        f"more.yaml: {ENTRY}: {{reason: because, key: type}}",
    )
    status, out = diff(run, "--breaking", "--format", "json")
    data = json.loads(out)
    schema = json.loads(resources.resource_path("schemas", "diff.schema.json").read_text(encoding="utf-8"))
    assert [error.message for error in jsonschema_rs.validator_for(schema).iter_errors(data)] == []
    (change,) = data["changes"]
    assert (status, change["breaks"], change["accepted"]) == (1, ["sssa"], None)
    assert [(one["partner"], one["category"], one["why"][:15], one["agreed"]) for one in change["because"]] == [
        ("sssa", "wire", "gives `sensor_m", None)
    ]
    assert change["said"] == [{"file": "more.yaml", "key": "type", "reason": "because"}]
    assert data["breaking"] == {
        "severity": "error",
        "policy": {
            "wire": "error",
            "promise": "error",
            "meaning": "warning",
            "source": "note",
            "foreign": "off",
            "agreement": "error",
        },
        "fails": True,
        "judged": True,
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
    write(both, ROBOT, RETYPED + STRICT, f"review/sssa.yaml: {ENTRY}: {evil}, {evil}: y")
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
        assert ran.out.endswith(f"\nwarning: cannot be judged: `{broken}` cannot be read\n")
        (both / "new" / broken).write_text(files[broken].replace("/eye/image", "/eye/rgb"), encoding="utf-8")
    assert "breaks SSSA (wire): `eye.publishes.image`" in run("diff", "old", "new", "--breaking").out


TEXTS = """\
types: {Picture: {message: sensor_msgs/msg/Image, comment: in metres}}
"""
TYPED = ROBOT.replace("image: sensor_msgs/msg/Image", "image: Picture") + TEXTS
REWORDED = TYPED.replace("in metres", "in feet")
RENAMED = TYPED.replace("camera", "eye")


def policy(text: str) -> str:
    """Give the section with a policy on breaking changes."""
    return f"review: {{breaking: {text}}}\n" if text else ""


@pytest.mark.parametrize(
    ("changed", "policies", "expected"),
    [
        # One severity holds for wire and promise: texts and ids count no more than they do by default.
        (REWORDED, ("error", "error"), (0, "warning: 1 breaking change for SSSA (meaning)")),
        (REWORDED, ("note", "note"), (0, "note: 1 breaking change for SSSA (meaning)")),
        (
            REWORDED,
            ("off", "off"),
            (0, "`review.breaking` is off: this project does not ask what breaks another partner"),
        ),
        (RENAMED, ("error", "error"), (0, "note: 1 breaking change for SSSA (source)")),
        (RENAMED, ("", ""), (0, "note: 1 breaking change for SSSA (source)")),
        # Each category by itself, and the stricter of both versions for each.
        (REWORDED, ("{meaning: off}", "{meaning: off}"), (0, "no change breaks another partner")),
        (REWORDED, ("{meaning: off}", ""), (0, "warning: 1 breaking change for SSSA (meaning)")),
        (
            REWORDED,
            ("{wire: error, meaning: note}", "{meaning: note}"),
            (0, "note: 1 breaking change for SSSA (meaning)"),
        ),
        (RENAMED, ("{source: off}", "{source: off}"), (0, "no change breaks another partner")),
        (
            REWORDED,
            ("{meaning: error}", "off"),
            (
                1,
                "error: 1 breaking change for SSSA (meaning); `review.breaking: {meaning: error}` refuses what is not accepted",
            ),
        ),
        (
            RENAMED,
            ("{wire: off}", "{source: error}"),
            (
                1,
                "error: 1 breaking change for SSSA (source); `review.breaking: {source: error}` refuses what is not accepted",
            ),
        ),
    ],
)
def test_each_category_has_a_severity(
    run: Run, both: Path, changed: str, policies: tuple[str, str], expected: tuple[int, str]
) -> None:
    before, after = map(policy, policies)
    write(both, TYPED + before, changed + after)
    status, out = diff(run, "--breaking")
    assert (status, expected[1] in out.splitlines()) == (expected[0], True)


def test_an_acceptance_counts_for_every_category_of_the_change(run: Run, both: Path) -> None:
    strict = policy("{meaning: error}")
    write(both, TYPED + strict, REWORDED + strict, "review/sssa.yaml: Picture: {key: comment, reason: we know}")
    status, out = diff(run, "--breaking")
    assert (status, out.splitlines()[-1]) == (0, "1 breaking change for SSSA (meaning), accepted")


def test_other_ids_alone_stand_among_the_other_changes_unless_they_matter(run: Run, both: Path) -> None:
    write(both, TYPED, RENAMED)
    assert diff(run)[1] == (
        "sensing: Sensing (CERTH)\n"
        "  > component `sensing.camera` is called `eye` now; "
        "for SSSA only ids change (source)\n"
        "\n"
        "1 change (1 renamed); concerns CERTH, SSSA\n"
    )
    assert "breaks" not in diff(run, "--format", "markdown")[1]
    loud = policy("{source: warning}")
    write(both, TYPED + loud, RENAMED + loud)
    assert diff(run)[1].startswith("Breaking changes\n  > breaks SSSA (source): component `sensing.camera`")


def test_the_gravest_stands_first_and_of_one_change_the_gravest_counts(run: Run, both: Path) -> None:
    mixed = policy("{meaning: error, wire: note}")
    text = TYPED.replace("outputs: {image: Picture}", "outputs: {image: Picture, depth: Depth}")
    text = text.replace("inputs: {image: camera.image}", "inputs: {image: camera.image, depth: camera.depth}")
    after = text.replace("in metres", "in feet").replace(", depth: Depth}", "}").replace(", depth: camera.depth", "")
    write(both, text + mixed, after + mixed)
    status, out = diff(run, "--breaking")
    assert status == 1
    assert [line.split(":")[0] for line in out.splitlines() if line[:2] == "  " != line[2:4]] == [
        "  ~ breaks SSSA (meaning)",
        "  - breaks SSSA (wire)",
        "  = help",
    ]


def test_an_unknown_category_is_told_with_a_guess(run: Run, both: Path) -> None:
    write(both, ROBOT, ROBOT + policy("{wrie: error}"))
    ran = run("check", "b")
    assert ran.status == 1
    assert "a policy on breaking changes has no key `wrie`" in ran.out
    assert "did you mean `wire`?" in ran.out


def test_what_cannot_be_judged_is_refused_if_any_category_is_an_error(run: Run, both: Path) -> None:
    for text, status in (("{source: error}", 1), ("{wire: warning}", 0)):
        write(both, ROBOT + policy(text), ROBOT + policy(text))
        (both / "b" / "more.yaml").write_text("groups: [", encoding="utf-8")
        ran = run("diff", "./a", "./b", "--breaking")
        assert (ran.status, "cannot be judged: `more.yaml` cannot be read" in ran.out) == (status, True)
