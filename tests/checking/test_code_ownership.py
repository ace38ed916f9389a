"""Owners: several of one element, inherited at all levels; who owns which files; CODEOWNERS and its escapes."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path

import jsonschema_rs
import pytest

import archgen
from archgen import resources
from archgen.analyses.size_counts import measure_progress
from archgen.checking import code_ownership
from archgen.emit.codeowners_file import REVIEWER_HANDLE, file_pattern
from archgen.model.architecture import Architecture
from archgen.model.selector_evaluation import evaluate_selector
from archgen.pipeline import check_project
from archgen.views.elements import element_card
from archgen.views.tables import element_rows
from tests.agreeing import DUO, checked, view
from tests.judged_projects import check_text, judge_ramcip
from tests.repositories import repository

OWNED = """\
partners: {p: {}, q: {}, r: {}}
groups:
  a:
    owner: [p, q]
    components:
      x: {title: X, inputs: {}, outputs: {}}
      y: {title: Y, owner: r, inputs: {}, outputs: {}}
  b: {components: {z: {title: Z, inputs: {}, outputs: {}}}}
nodes:
  n: {implements: a.x}
  m: {implements: [a.x, a.y]}
  o: {implements: a.y, owner: [q, r, q]}
"""


def test_owners_are_inherited_from_group_to_component_to_node(derived: Callable[[str], Architecture]) -> None:
    found = derived(OWNED)
    assert found.groups["a"].owners == ("p", "q")
    assert {name: each.owners for name, each in found.components.items()} == {
        "a.x": ("p", "q"),
        "a.y": ("r",),
        "b.z": (),
    }
    owners = {name: each.owners for name, each in found.nodes.items()}
    assert owners == {"n": ("p", "q"), "m": ("p", "q", "r"), "o": ("q", "r"), "z": ()}
    assert [each.owner for each in found.nodes.values()] == ["p", "p", "q", None]


def test_a_selector_finds_every_owner(derived: Callable[[str], Architecture]) -> None:
    found = derived(OWNED)
    chosen, problems = evaluate_selector("owner:q", found, {})
    assert (problems, chosen.components, chosen.nodes) == ((), {"a.x"}, {"n", "m", "o"})


def test_progress_counts_a_shared_component_for_each_owner(derived: Callable[[str], Architecture]) -> None:
    rows = {row.id: row.components for row in measure_progress(derived(OWNED)) if row.scope == "partner"}
    assert rows == {"p": 1, "q": 1, "r": 1, "": 1}


def test_show_and_list_name_all_owners(tmp_path: Path) -> None:
    found = view(checked(tmp_path))
    assert ("owner", "north, south") in element_card.make_card(found, "component", "moving.calibration").facts
    assert ("owner", "west") in element_card.make_card(found, "node", "arm_node").facts
    partner = element_card.make_card(found, "partner", "south")
    assert partner.facts == (("reviewers", "@duo/south, lee@south.example"),)
    assert dict(partner.lists)["components"][-2:] == ("moving.calibration", "moving.watch")
    columns, rows = element_rows.list_element_rows(found, "nodes")
    assert {row[0]: row[columns.index("owner")] for row in rows}["arm_node"] == "west"


@pytest.mark.parametrize(
    ("written", "said"),
    [
        ("owner: [p, nobody]", "no partner named `nobody`"),
        ("owner: [p, No One]", "an id is lower-case words joined by `_`"),
        ("owner: {p: q}", "must be text or a list"),
    ],
)
def test_owners_that_are_none(written: str, said: str) -> None:
    found = check_text(f"archgen: 1\npartners: {{p: {{}}}}\ngroups:\n  a:\n    {written}\n    components: {{x: X}}\n")
    errors = [finding for finding in found if finding.severity == "error"]
    assert [finding.span.line for finding in errors] == [5]
    assert said in f"{errors[0].message} {errors[0].help}"


@pytest.mark.parametrize("written", ['"ramcip/certh"', '"@a b"', '"@a/"', '["@a", "#b"]', "maria"])
def test_reviewers_are_handles(written: str) -> None:
    found = check_text(f"archgen: 1\npartners:\n  p: {{reviewers: {written}}}\n")
    errors = [finding for finding in found if finding.severity == "error"]
    assert [finding.span.line for finding in errors] == [3]
    assert "@organisation/team" in f"{errors[0].message} {errors[0].help}"


def test_a_shared_element_survives_packing(tmp_path: Path) -> None:
    project = archgen.load(checked(tmp_path).root)
    project.write_packed(tmp_path / "packed.yaml")
    again = check_project(tmp_path / "packed.yaml").architecture
    assert again.components["moving.calibration"].owners == ("north", "south")
    assert again.partners == project.architecture.partners
    record = project.record()
    validator = jsonschema_rs.validator_for(
        json.loads(resources.resource_path("schemas", "resolved.schema.json").read_text("utf-8"))
    )
    assert list(validator.iter_errors(dict(record))) == []
    assert record["partners"]["south"] == {"title": "South Vision", "reviewers": ["@duo/south", "lee@south.example"]}
    assert record["components"]["moving.calibration"]["co_owners"] == ["south"]
    assert "co_owners" not in record["components"]["moving.arm"]


SLICES = {
    "archgen.yaml": 'archgen: 1\npartners:\n  p: {reviewers: "@a/p"}\n  q: {reviewers: ["@a/q", q@x.org]}\n  r: {}\n'
    'ros: {interfaces: ["msg/**/*.msg"]}\n',
    "msg/m_msgs/msg/Stop.msg": "bool stop\n",
    "groups/a.yaml": "groups: {a: {owner: p, components: {x: X, y: {title: Y, owner: q}}}}\n",
    "groups/b.yaml": "groups: {b: {owner: q, components: {z: Z}}}\n",
    "groups/b_more.yaml": "groups: {b: {components: {w: {title: W, owner: r}}}}\n",
    "groups/free.yaml": "groups: {free: {components: {v: V}}}\n",
    "nodes of p.yaml": "nodes: {n: {implements: a.x}}\n",
    "timing.yaml": "groups: {a: {components: {x: {timing: {rate: 1 Hz}}}}, b: {components: {z: {timing: {rate: 1 Hz}}}}}\n",
}
EVERYBODY = "@a/p @a/q q@x.org"
GUARDS = [
    f"{path} {EVERYBODY}" for path in ("/.github/", "/.gitlab/", "/.gitlab-ci.yml", "/CODEOWNERS", "/docs/CODEOWNERS")
]
LINES = [
    # First, since the last one counts: what is new, and in no line below.
    f"/robot/ {EVERYBODY}",
    "# /robot/archgen.yaml: r without reviewers",
    "/robot/archgen.yaml @a/p @a/q q@x.org",
    "/robot/groups/a.yaml @a/p @a/q q@x.org",
    "/robot/groups/b.yaml @a/q q@x.org",
    "# /robot/groups/b_more.yaml: r without reviewers",
    "# /robot/groups/free.yaml: r without reviewers",
    "/robot/groups/free.yaml @a/p @a/q q@x.org",
    "# /robot/msg/m_msgs/msg/Stop.msg: r without reviewers",
    "/robot/msg/m_msgs/msg/Stop.msg @a/p @a/q q@x.org",
    "/robot/nodes\\ of\\ p.yaml @a/p",
    "/robot/review/p.yaml @a/p",
    "/robot/review/q.yaml @a/q q@x.org",
    "# /robot/review/r.yaml: r without reviewers",
    "/robot/timing.yaml @a/p @a/q q@x.org",
    *GUARDS,
]


def test_every_slice_belongs_to_the_owners_of_what_stands_there(tmp_path: Path) -> None:
    repository(tmp_path, {f"robot/{name}": text for name, text in SLICES.items()})
    found = code_ownership.make_codeowners(check_project(tmp_path / "robot"))
    assert [
        line for line in found.text.splitlines() if (line and not line.startswith("# ")) or "/robot/" in line
    ] == LINES
    (warning,) = found.warnings
    assert warning.startswith('`r` owns files and has no reviewers: write `reviewers: "@organisation/team"`')


def test_outside_of_a_repository_paths_begin_at_the_project(tmp_path: Path) -> None:
    assert (
        "\n/archgen.yaml @duo/north @duo/south lee@south.example\n"
        in code_ownership.make_codeowners(checked(tmp_path)).text
    )


def test_who_owns_what(tmp_path: Path) -> None:
    repository(tmp_path, dict(SLICES))
    found = code_ownership.find_ownership(check_project(tmp_path))
    p, q, r = found.partners
    assert (p.elements["group"], p.elements["component"], p.elements["node"]) == (("a",), ("a.x",), ("n",))
    assert q.files == ("groups/a.yaml", "groups/b.yaml", "timing.yaml")
    assert r.elements["component"] == ("b.w",)
    assert found.nobody.elements == {"group": ("free",), "component": ("free.v",), "node": ()}
    assert found.nobody.files == ("archgen.yaml", "groups/free.yaml")


@pytest.mark.parametrize(
    ("path", "line"),
    [
        ("a/b.yaml", "/a/b.yaml"),
        ("a b/c.yaml", "/a\\ b/c.yaml"),
        ("#a/[b]*.yaml", "/?a/?b??.yaml"),
        ("!a\\b?.yaml", "/?a?b?.yaml"),
        ("a\n@evil/team\tb.yaml", "/a?@evil/team?b.yaml"),
        ("größe.yaml", "/größe.yaml"),
        ("a\u2028b{c,d}.yaml", "/a?b?c,d?.yaml"),
    ],
)
def test_a_pattern_matches_its_file_and_breaks_out_of_no_line(path: str, line: str) -> None:
    assert file_pattern(path) == line
    assert len(line.splitlines()) == 1
    unescaped = re.sub(r"\\(.)", r"\1", line)
    assert re.fullmatch("".join("." if c == "?" else re.escape(c) for c in unescaped), f"/{path}", re.DOTALL)


def test_every_line_is_a_pattern_with_handles(tmp_path: Path) -> None:
    text = code_ownership.make_codeowners(judge_ramcip()).text
    for line in [*text.splitlines(), *code_ownership.make_codeowners(checked(tmp_path, DUO)).text.splitlines()]:
        path, *handles = re.split(r"(?<!\\) ", line)
        assert (
            not line
            or line.startswith("#")
            or ((path == "*" or path.startswith("/")) and handles and all(map(REVIEWER_HANDLE.match, handles)))
        )
