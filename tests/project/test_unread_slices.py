"""A slice is read or named, whatever it is called, wherever it lies, however it begins and is encoded."""

from __future__ import annotations

import gzip
import json
from pathlib import Path

import pytest

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.diagnostics.source_span import NO_SPAN
from archgen.emit.terminal.findings_text import render_findings_text
from archgen.pipeline import check_project
from archgen.project.source_patterns import blame_unread_files

SLICE = "groups:\n  g:\n    components:\n      weeder: {outputs: {x: T}}\n"
LINES = SLICE.splitlines(keepends=True)
DATA = {"groups": {"g": {"components": {"weeder": {"outputs": {"x": "T"}}}}}}

ODD_FILES: dict[str, bytes] = {
    # names
    **{
        name: SLICE.encode()
        for name in (
            "weeder.yml",
            "weeder.YAML",
            "weeder.Yml",
            "weeder.yaml.txt",
            "weeder.yaml.bak",
            "weeder.yaml~",
            "weeder.ymal",
            "weeder.yamll",
            "weeder.txt",
            "weeder",
            "weeder.yaml.yaml",
            "my weeder.yaml",
            "wéeder.yaml",
            "#weeder.yaml",
            ".weeder.yaml",
            "weeder.yaml.orig",
        )
    },
    "weeder.json": json.dumps(DATA).encode(),
    "weeder.jsonc": b"// ours\n" + json.dumps(DATA, indent=2).encode(),
    # places
    **{
        f"{place}/weeder.yaml": SLICE.encode()
        for place in (
            "groups/deep/er",
            "backends",
            "archgen-out",
            ".hidden",
            ".github/parts",
            "build",
            "node_modules",
            "passes",
            "more/backends/x",
            "groups/archgen-out",
            "own",
        )
    },
    # tops
    "tops/version.yaml": f"archgen: 1\n{SLICE}".encode(),
    "tops/project.yaml": f"archgen: 1\nproject: {{id: weeder}}\n{SLICE}".encode(),
    "tops/Groups.yaml": SLICE.replace("groups", "Groups").encode(),
    "tops/group.yaml": SLICE.replace("groups", "group").encode(),
    "tops/without_section.yaml": "".join(LINES[1:]).encode(),
    "tops/components.yaml": "".join(LINES[2:]).encode(),
    "tops/indented.yaml": "".join(f"  {line}" for line in LINES).encode(),
    "tops/wrapped.yaml": ("architecture:\n" + "".join(f"  {line}" for line in LINES)).encode(),
    "tops/list.yaml": ("- " + "  ".join(LINES)).encode(),
    "tops/fenced.yaml": f"```yaml\n{SLICE}```\n".encode(),
    "tops/two_documents.yaml": f"{SLICE}---\n{SLICE}".encode(),
    "tops/directive.yaml": f"%YAML 1.2\n---\n{SLICE}".encode(),
    "tops/conflict.yaml": f"<<<<<<< HEAD\n{SLICE}=======\n>>>>>>> other\n".encode(),
    # encodings
    "encoded/mark.yaml": SLICE.encode("utf-8-sig"),
    "encoded/utf_16.yaml": SLICE.encode("utf-16"),
    "encoded/latin_1.yaml": f"# für\n{SLICE}".encode("latin-1"),
    "encoded/windows.yaml": SLICE.replace("\n", "\r\n").encode(),
    "encoded/old_mac.yaml": SLICE.replace("\n", "\r").encode(),
    "encoded/tabs.yaml": SLICE.replace("  ", "\t").encode(),
    "encoded/packed.yaml": gzip.compress(SLICE.encode(), mtime=0),
}
"""One valid slice, but for what its name says."""


def look(folder: Path) -> tuple[set[str], str]:
    """Return the ids of a project's components, and what the terminal says of it."""
    checked = check_project(folder)
    lines = render_findings_text(checked.findings, checked.sources, colour=False, width=200)
    return set(checked.architecture.components), "\n".join(lines)


def write(folder: Path, name: str, data: bytes, head: str = "archgen: 1\n") -> None:
    (folder / "archgen.yaml").write_text(head, encoding="utf-8")
    (folder / name).parent.mkdir(parents=True, exist_ok=True)
    (folder / name).write_bytes(data)


def test_there_are_forty_odd_files() -> None:
    assert len(ODD_FILES) >= 40


@pytest.mark.parametrize("head", ["archgen: 1\n", 'archgen: 1\nsources: ["groups/*.yaml"]\n'])
@pytest.mark.parametrize("name", ODD_FILES)
def test_a_slice_is_read_or_named(tmp_path: Path, name: str, head: str) -> None:
    data = ODD_FILES[name]
    if "sources" in head and name.startswith(("tops", "encoded")):
        name = f"groups/{Path(name).name}"
    write(tmp_path, name, data, head)
    write(tmp_path, "groups/types.yaml", b"types: {T: {}}\n", head)
    if name.startswith("own/"):
        (tmp_path / "own/archgen.yaml").write_text("archgen: 1\n", encoding="utf-8")
        name = "own/"
    components, words = look(tmp_path)
    assert "g.weeder" in components or name in words


def test_a_copy_beside_a_file_that_is_read_is_no_loss(tmp_path: Path) -> None:
    for name in ("a.yaml", "a.yaml~", "a.yaml.orig"):
        write(tmp_path, name, SLICE.encode())
    assert "ignored-file" not in look(tmp_path)[1]


def test_folders_of_data_and_of_tools_are_not_searched(tmp_path: Path) -> None:
    for number in range(101):
        write(tmp_path, f"labels/{number}.txt", SLICE.encode())
    for name in (".git/x.yaml", ".venv/pyvenv.cfg", ".venv/lib/x.yaml", ".cache/CACHEDIR.TAG", ".cache/x.yaml"):
        write(tmp_path, name, SLICE.encode())
    assert look(tmp_path) == (set(), "no findings")


def test_a_link_out_of_the_project_is_named(tmp_path: Path) -> None:
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
    write(tmp_path / "a", "x.txt", b"")
    write(tmp_path / "b", "weeder.yaml", SLICE.encode())
    (tmp_path / "a/weeder.yaml").symlink_to(tmp_path / "b/weeder.yaml")
    assert "weeder.yaml" in look(tmp_path / "a")[1]


def test_what_is_left_out_stands_in_the_errors_that_ask_for_it(tmp_path: Path) -> None:
    write(
        tmp_path,
        "groups/supervision.yaml",
        b"groups: {supervision: {components: {arm_driver: {outputs: {state: S}}}}}\nhosts: {pc: {}}\n",
    )
    text = b"groups: {b: {components: {base_driver: {inputs: {a: supervision.arm_driver.state}}}}}\nnodes: {n: {implements: b.base_driver, host: pc}}\n"
    write(tmp_path, "groups/base.yaml", text, "archgen: 1\nsources: [groups/base.yaml]\n")
    findings = [(d.message, d.help) for d in check_project(tmp_path).findings if d.rule == "unknown-reference"]
    help_line = "`groups/supervision.yaml` declares it, and is not read: add it to `sources` of archgen.yaml"
    assert findings == [
        ("no output named `supervision.arm_driver.state`", help_line),
        ("no host named `pc`", help_line),
    ]


def test_a_reference_that_nothing_unread_declares_keeps_its_help() -> None:
    findings = [
        Diagnostic("unknown-reference", f"no output named `{name}`", NO_SPAN) for name in ("g.a.x", "a.x", "x.a")
    ]
    told = blame_unread_files(findings, {"b.yaml": frozenset({"g.a", "g.a.x"})})
    assert [bool(finding.help) for finding in told] == [True, True, False]


STRANGERS = {
    "ops/alerts.yaml": "groups:\n- name: a\n  rules:\n  - alert: Down\n    expr: up == 0\n",
    "ops/cluster.yaml": "kind: Cluster\napiVersion: kind.x-k8s.io/v1alpha4\nnodes:\n- role: control-plane\n- role: worker\n",
    "ops/kustomization.yaml": "resources:\n- deployment.yaml\n- service.yaml\n",
    "ops/playbook.yml": "- hosts: all\n  tasks:\n  - name: update\n    apt: {upgrade: dist}\n",
    "ops/inventory.yaml": "hosts:\n  web: {ansible_host: 10.0.0.1, ansible_user: me}\n",
    "ops/chart.yaml": "{{- if .Values.on }}\nhosts:\n  - {{ .Values.host }}\n{{- end }}\n",
    "ops/manifests.yaml": "apiVersion: v1\nkind: List\nnodes: []\n---\napiVersion: v1\n",
    "_quarto.yml": "project: {type: website}\nformat: html\n",
    "myst.yml": "version: 1\nproject: {title: Docs}\nsite: {template: book}\n",
    "dvc.yaml": "stages: {train: {cmd: python train.py, deps: [a]}}\n",
    "labels.yml": "- name: bug\n  color: ff0000\n",
    "robot.urdf.yaml": "links: {base: {mass: 1.0, inertia: [1, 1, 1]}}\njoints: {wheel: {parent: base}}\n",
    "compose.yaml": "services: {web: {image: nginx}}\nnetworks: {front: {}}\n",
    ".github/workflows/ci.yml": "on: push\njobs: {a: {runs-on: ubuntu, steps: []}}\n",
    "params.yaml": "node:\n  ros__parameters: {rate: 10}\n",
    "view.rviz.yaml": "Panels: []\nVisualization Manager: {Class: ''}\n",
    "slices.json": '{"types": [{"id": 1}], "links": []}\n',
}


@pytest.mark.parametrize("head", ["archgen: 1\n", 'archgen: 1\nsources: ["**/*.yaml", "**/*.yml"]\n'])
def test_files_of_other_programs_are_one_note(tmp_path: Path, head: str) -> None:
    for name, text in STRANGERS.items():
        write(tmp_path, name, text.encode(), head)
    write(tmp_path, "groups/weeder.yaml", SLICE.encode(), head)
    findings = [d for d in check_project(tmp_path).findings if d.rule == "ignored-file" or d.severity == "error"]
    assert [(d.rule, d.severity) for d in findings] == [("ignored-file", "note")]
    assert "`sources`" in str(findings[0].help)
    assert {name for name in STRANGERS if f"`{name}`" in findings[0].message} == {
        name for name in STRANGERS if not name.startswith(".") and not name.endswith(".json")
    }


@pytest.mark.parametrize(
    "text",
    [
        "nodes: {n: {implement: g.weeder}}\n",  # one slip, and nothing else
        "groups:\n- id: g\n  components: {weeder: {outputs: {x: T}}}\n",
        "types: {n: {implements: g.weeder, package: p}}\n",
        "hosts: [pc, robot]\n",
        "components: {weeder: {outputs: {x: T}}}\n",
        "components:\n  weeder:\n    title: Weeder\n    inputs: {a: b.c}\n",
    ],
)
def test_slips_of_a_slice_stay_errors(tmp_path: Path, text: str) -> None:
    write(tmp_path, "a.yaml", text.encode())
    errors = [d for d in check_project(tmp_path).findings if d.severity == "error"]
    assert [d.span.file for d in errors[:1]] == ["a.yaml"]
    assert errors[0].help
