"""What verbs that read print for programs: each has a schema, and holds to it."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema_rs
import pytest

from archgen import resources
from archgen.cli import VERBS
from tests import repositories
from tests.cli.conftest import ROOT, Run
from tests.property_sizes import try_some

ROBOT = ROOT / "example_ramcip"
IN_OTHER_TESTS = {
    "conform": "as check: tests/cli/test_conform_verb.py",
    "diff": "tests/cli/test_diff.py",
    "merge": "tests/cli/test_merge.py",
    "merge-check": "tests/cli/test_merge_check.py",
    "simulate": "tests/cli/test_reading_verbs.py",
    "start": "tests/cli/test_start.py",
    "import": "what was taken, in words for a person who looks after it",
    "new": "a file that it wrote",
    "undo": "a file that it wrote",
    "check": "tests/cli/test_reading_verbs.py",
}
"""Verbs with JSON that is held against its schema elsewhere, or that tell a person what they wrote."""
NO_JSON = {
    *(
        "init",
        "fmt",
        "serve",
        "build",
        "report",
        "slides",
        "site",
        "diagram",
        "review",
        "sign",
        "pack",
        "transform",
        "generate",
    ),
    *("export", "schema", "lsp", "mcp", "merge-driver", "check-requests", "comment", "completion"),
}
"""Verbs that write files or serve: what they make is the answer."""
ASKED = {
    "show": ("show", "navigator", "-C", ROBOT, "R-23", "state", "certh"),
    "list": ("list", "-C", ROBOT),
    "find": ("find", "fall", "alarm", "-C", ROBOT),
    "stats": ("stats", ROBOT),
    "owners": ("owners", ROBOT),
    "explain": ("explain",),
    "impact": ("impact", ROBOT, "--partner", "certh"),
    "todo": ("todo", ROBOT, "--partner", "certh"),
    "interfaces": ("interfaces", ROBOT, "--between", "certh", "tum"),
    "rename": ("rename", "navigator", "driver", "-C", ROBOT, "--dry-run"),
    "move": ("move", "navigator", "robot_state", "-C", ROBOT, "--dry-run"),
    "split": ("split", "groups/human_state.yaml", "-C", ROBOT, "--dry-run"),
    "timing": ("timing", ROBOT),
}


def read_schema(verb: str) -> dict[str, object]:
    if verb == "timing":
        text = resources.resource_path("schemas", "timing.schema.json").read_text("utf-8")
        return dict(json.loads(text))
    schema = json.loads(resources.resource_path("schemas", "answers.schema.json").read_text("utf-8"))
    definition = "rename" if verb in {"move", "split"} else verb
    return {"$schema": schema["$schema"], "$defs": schema["$defs"], "$ref": f"#/$defs/{definition}"}


@pytest.mark.parametrize("verb", try_some(ASKED, 6))
def test_an_answer_holds_to_its_schema(run: Run, verb: str) -> None:
    ran = run(*ASKED[verb], "--format", "json")
    assert ran.status in {0, 1}, ran.err
    errors = jsonschema_rs.Draft202012Validator(read_schema(verb)).iter_errors(json.loads(ran.out))
    assert [f"{each.instance_path}: {each.message[:200]}" for each in errors] == []


def test_every_verb_has_an_answer_for_programs_or_a_reason_why_not() -> None:
    assert sorted([*ASKED, *IN_OTHER_TESTS, *NO_JSON]) == sorted({*VERBS})
    schema = json.loads(resources.resource_path("schemas", "answers.schema.json").read_text("utf-8"))
    manual = (ROOT / "docs/scripts.md").read_text("utf-8")
    assert [verb for verb in ASKED if f"`{verb}`" not in manual] == []
    assert [
        name for name in schema["$defs"] if "description" in schema["$defs"][name] and name not in {*ASKED, "time"}
    ] == []


def test_a_refused_refactoring_is_an_answer_too(run: Run) -> None:
    ran = run("rename", "navigator", "a b{", "-C", ROBOT, "--dry-run", "--format", "json")
    assert ran.status == 2
    jsonschema_rs.validate(read_schema("rename"), json.loads(ran.out))


def test_words_find_names_before_texts(run: Run, tmp_path: Path) -> None:
    folder = repositories.repository(tmp_path / "robot")
    (folder / "archgen.yaml").write_text(
        "archgen: 1\ngroups:\n  sense:\n    components:\n"
        "      eye: {title: Camera, functionality: Sees what an ear hears., outputs: {image: Image}}\n"
        "      ear: {outputs: {sound: Sound}}\n"
    )
    ran = run("find", "EAR", "-C", folder)
    names = [line.split()[1] for line in ran.out.splitlines()]
    assert (ran.status, names[0]) == (0, "Ear")
    assert any("Camera (sense.eye)" in line for line in ran.out.splitlines()[1:])
    assert "Camera" in run("find", "hears", "sees", "-C", folder).out
    # Words of questions count where nothing else is asked for.
    assert run("find", "who reads the sound", "-C", folder).out == run("find", "sound", "-C", folder).out != ""
    assert "Sees what an ear hears" not in run("find", "what", "-C", folder).out
    assert "Camera" in run("find", "what", "-C", folder).out
    nothing = run("find", "nose", "-C", folder)
    assert (nothing.status, nothing.out) == (1, "nothing is called or described so\n")
