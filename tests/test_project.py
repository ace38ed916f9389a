"""Finding a project, its files and their order."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from archgen.diagnostics.diagnostic import Severity
from archgen.project import LoadedProject, ProjectNotFoundError, load_project


def project(root: Path) -> Path:
    """Make the folder a project that says nothing."""
    (root / "archgen.yaml").write_text("archgen: 1\n")
    return root


def write(root: Path, files: dict[str, str]) -> Path:
    """Write files below a folder."""
    for name, text in files.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return root


def names(loaded: LoadedProject) -> list[str]:
    """Name the documents in order."""
    return [document.file for document in loaded.documents]


def findings(loaded: LoadedProject) -> list[str]:
    """Give the findings as `place rule: message`."""
    return [f"{d.span} {d.rule}: {d.message}" for d in loaded.diagnostics]


def test_everything_below_by_default(tmp_path: Path) -> None:
    write(
        tmp_path,
        {
            "archgen.yaml": "archgen: 1\n",
            "z.yaml": "hosts: {h: }",
            "b/c.yaml": "hosts: {i: }",
            "b/a.yaml": "hosts: {j: }",
            "b.yaml": "hosts: {k: }",
            ".hidden/x.yaml": "hosts: {x: }",
            ".x.yaml": "hosts: {x: }",
            "backends/x.yaml": "hosts: {x: }",
            "archgen-out/packed.yaml": "hosts: {x: }",
            "other/archgen.yaml": "archgen: 1",
            "other/deep/x.yaml": "hosts: {x: }",
            "packed.yaml": "archgen: 1\nhosts: {x: }",
            "empty.yaml": "",
            "readme.yml": "hosts: {x: }",
        },
    )
    loaded = load_project(tmp_path)
    assert names(loaded) == ["archgen.yaml", "b/a.yaml", "b/c.yaml", "b.yaml", "readme.yml", "z.yaml"]
    hidden = "`.hidden/x.yaml`, `.x.yaml`, `archgen-out/packed.yaml` and `backends/x.yaml`"
    assert findings(loaded) == [
        "packed.yaml:1:1 ignored-file: `archgen:` makes this file a project of its own: it is no part of this one",
        f"archgen.yaml:1:1 ignored-file: {hidden} hold a part of an architecture and are not read: hidden files, outputs and the folder `backends` are not searched",
        "archgen.yaml:1:1 ignored-file: `other/` is no part of this project: archgen.yaml there makes a project of its own",
    ]


def test_files_without_a_section_are_listed_in_one_note(tmp_path: Path) -> None:
    write(
        project(tmp_path), {"params.yaml": "speed: 1", "ci/x.yaml": "on: push\njobs: !x {}", "s.yaml": "hosts: {h: }"}
    )
    loaded = load_project(tmp_path)
    assert names(loaded) == ["archgen.yaml", "s.yaml"]
    assert findings(loaded) == [
        "archgen.yaml:1:1 ignored-file: `ci/x.yaml`, `params.yaml` hold no element of the language and are not read"
    ]


def test_of_many_files_of_others_some_are_named_first_what_may_be_a_slice(tmp_path: Path) -> None:
    files = {f"config/p{number:02}.yaml": "speed: 1" for number in range(40)}
    write(project(tmp_path), files | {"z.yaml": "grops: {}", "s.yaml": "hosts: {h: }"})
    (note,) = findings(load_project(tmp_path))
    assert note.startswith("archgen.yaml:1:1 ignored-file: `z.yaml`, `config/p00.yaml`, ")
    assert note.endswith("`config/p22.yaml` and 17 more hold no element of the language and are not read")


def test_a_slip_in_the_only_section_is_guessed(tmp_path: Path) -> None:
    write(project(tmp_path), {"a.yaml": "grops: {}"})
    assert load_project(tmp_path).diagnostics[0].help == "did you mean `groups:` in `a.yaml`?"


def test_a_broken_slice_is_reported_and_the_others_are_read(tmp_path: Path) -> None:
    write(project(tmp_path), {"a.yaml": "groups:\n  g: {title: x\n", "b.yaml": "hosts: {h: }"})
    loaded = load_project(tmp_path)
    assert names(loaded) == ["archgen.yaml", "b.yaml"]
    assert findings(loaded) == ["a.yaml:2:6 syntax-error: this `{` is not closed"]
    assert loaded.lost_keys == frozenset({"groups", "g", "title"})
    assert loaded.sources.line_of("a.yaml", 2) == "  g: {title: x"


def test_sources_in_their_order(tmp_path: Path) -> None:
    text = 'archgen: 1\nsources: [z.yaml, "g/*.yaml", "**/t.yaml", "g/b?[0-9].yaml", nothing.yaml, ../x.yaml, /etc/x.yaml]\n'
    write(tmp_path, {"archgen.yaml": text, "a.yaml": "", "z.yaml": "hosts: {z: }"})
    write(
        tmp_path,
        {
            "g/b.yaml": "hosts: {b: }",
            "g/a.yaml": "",
            "g/h/t.yaml": "",
            "t.yaml": "",
            "g/bx1.yaml": "",
        },
    )
    loaded = load_project(tmp_path)
    assert names(loaded) == ["archgen.yaml", "z.yaml", "g/a.yaml", "g/b.yaml", "g/bx1.yaml", "g/h/t.yaml", "t.yaml"]
    assert findings(loaded) == [
        "archgen.yaml:2:76 wrong-value: `../x.yaml` leads out of the project's folder",
        "archgen.yaml:2:87 wrong-value: `/etc/x.yaml` leads out of the project's folder",
        "archgen.yaml:2:62 missing-source: `nothing.yaml` matches no file",
    ]


def test_a_packed_file_is_left_out_unless_it_is_named(tmp_path: Path) -> None:
    write(
        tmp_path,
        {"archgen.yaml": 'archgen: 1\nsources: ["*.yaml"]', "packed.yaml": "archgen: 1", "a.yaml": "hosts: {h: }"},
    )
    assert names(load_project(tmp_path)) == ["archgen.yaml", "a.yaml"]
    write(tmp_path, {"archgen.yaml": "archgen: 1\nsources: [packed.yaml]"})
    assert names(load_project(tmp_path)) == ["archgen.yaml", "packed.yaml"]


def test_a_single_file_is_the_whole_project(tmp_path: Path) -> None:
    write(project(tmp_path), {"My robot-2.yaml": "groups: {g: G}", "b.yaml": "hosts: {h: }"})
    loaded = load_project(tmp_path / "My robot-2.yaml")
    assert (names(loaded), loaded.id, loaded.title) == (["My robot-2.yaml"], "my_robot_2", "My robot 2")
    assert names(load_project(tmp_path / "archgen.yaml")) == ["archgen.yaml", "My robot-2.yaml", "b.yaml"]


def test_the_project_around_the_current_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (project(tmp_path) / "a" / "b").mkdir(parents=True)
    monkeypatch.chdir(tmp_path / "a" / "b")
    assert load_project().root == tmp_path.resolve()


def test_no_project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(ProjectNotFoundError, match=r"holds no archgen.yaml: `archgen init` makes one"):
        load_project(tmp_path)
    with pytest.raises(ProjectNotFoundError, match=r"x.yaml does not exist"):
        load_project(tmp_path / "x.yaml")
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ProjectNotFoundError, match=r"no archgen.yaml here or in a folder above"):
        load_project()


def test_what_the_project_says_of_itself(tmp_path: Path) -> None:
    text = (
        "archgen: 1\nros: {distro: jazzy, interfaces: ['msgs/**/*.msg', '../x/*.msg', none/*.srv]}\nlayout: {direction: top-bottom}\n"
        "rules: {unread-output: off, no-such: error}\nreport: {chapters: [docs/a.md, groups]}\n"
    )
    write(
        tmp_path,
        {"archgen.yaml": text, "msgs/p/A.msg": "", "msgs/B.msg": "", "a.yaml": "hosts: {h: } # archgen: ignore[x] y"},
    )
    loaded = load_project(tmp_path)
    assert loaded.rule_settings == {"unread-output": Severity.OFF, "no-such": Severity.ERROR}
    assert str(loaded.rule_spans["no-such"]) == "archgen.yaml:4:29"
    assert loaded.distro == "jazzy"
    assert loaded.interface_files == ("msgs/B.msg", "msgs/p/A.msg")
    assert [ignore.rules for ignore in loaded.ignores["a.yaml"]] == [("x",)]
    assert [d.rule for d in loaded.diagnostics] == ["wrong-value", "missing-source"]


def test_another_version_of_the_language(tmp_path: Path) -> None:
    write(tmp_path, {"archgen.yaml": "archgen: 2\n"})
    assert findings(load_project(tmp_path)) == [
        "archgen.yaml:1:10 wrong-value: this archgen reads version 1 of the language, not `2`"
    ]


def test_hostile_things_in_the_folder(tmp_path: Path) -> None:
    secret = write(tmp_path, {"secret.yaml": "hosts: {secret: }"}) / "secret.yaml"
    root = tmp_path / "project"
    root.mkdir()
    project(root)
    os.mkfifo(root / "a.yaml")
    (root / "b.yaml").mkdir()
    (root / "c.yaml").symlink_to(root / "nothing")
    (root / "d.yaml").symlink_to(secret)
    (root / "e").symlink_to(tmp_path)
    (root / "f.yaml").write_bytes(b"groups: \xff")
    (root / os.fsdecode(b"g\xff.yaml")).write_text("hosts: {g: }")
    (root / "h.yaml").write_text("hosts: {h: }")
    # A pipe that is opened would be waited for without an end.
    loaded = load_project(root)
    assert names(loaded) == ["archgen.yaml", "h.yaml"]
    assert sorted(findings(loaded)) == [
        "a.yaml:1:1 syntax-error: this is a named pipe, not a file",
        "archgen.yaml:1:1 syntax-error: a file's name cannot be read as text: 'g\\udcff.yaml'",
        "b.yaml:1:1 syntax-error: this is a folder, not a file",
        "c.yaml:1:1 syntax-error: this is a broken link: what it points to does not exist",
        "d.yaml:1:1 syntax-error: this link leads out of the project's folder",
        "f.yaml:1:9 syntax-error: the byte 0xFF is not UTF-8",
    ]
    # A file that is named itself may have been replaced by a branch under review, too.
    assert findings(load_project(root / "d.yaml")) == [
        "d.yaml:1:1 syntax-error: this link leads out of the project's folder"
    ]
    (root / "i.yaml").symlink_to("h.yaml")
    assert names(load_project(root / "i.yaml")) == ["h.yaml"]


@pytest.mark.parametrize("name", ["archgen.yaml", "robot.yaml"])
def test_a_marker_that_is_no_file(tmp_path: Path, name: str) -> None:
    (tmp_path / name).symlink_to("nothing")
    assert findings(load_project(tmp_path / name)) == [
        f"{name}:1:1 syntax-error: this is a broken link: what it points to does not exist"
    ]


def test_an_unreadable_marker_hides_nothing_else(tmp_path: Path) -> None:
    write(tmp_path, {"archgen.yaml": "archgen: [", "a.yaml": "hosts: {h: }", "params.yaml": "a: 1"})
    loaded = load_project(tmp_path)
    assert names(loaded) == ["a.yaml"]
    assert [d.rule for d in loaded.diagnostics] == ["syntax-error"]


@pytest.mark.parametrize(
    ("text", "finding"),
    [
        ("node: {n: {implements: a.b, package: p}}", "unknown-key: no section is called `node`"),
        ("perception: {components: {c: Camera}}", "unknown-key: no section is called `perception`"),
        ("host: {a: {title: x, port: 3}}\nserver: {host: x, threads: 3}", "ignored-file: `b.yaml` holds no element of the language and is not read"),
    ],
)  # fmt: skip
def test_a_file_whose_only_section_is_misspelt_is_a_slice_and_other_yaml_is_none(
    tmp_path: Path, text: str, finding: str
) -> None:
    write(tmp_path, {"archgen.yaml": "archgen: 1\n", "b.yaml": text})
    assert [line.split(" ", 1)[1] for line in findings(load_project(tmp_path))] == [finding]


@pytest.mark.parametrize(
    ("pattern", "guess"),
    [
        ("group/*.yaml", "groups/*.yaml"),
        ("groups", "groups/*.yaml"),
        ("groups/a.yml", "groups/a.yaml"),
        ("other/*.yaml", None),
    ],
)
def test_a_pattern_without_files_is_an_error_where_files_are_called_nearly_so(
    tmp_path: Path, pattern: str, guess: str | None
) -> None:
    write(
        tmp_path,
        {"archgen.yaml": f"archgen: 1\nsources: ['{pattern}']\n", "groups/a.yaml": "groups: {g: {components: {c: }}}"},
    )
    loaded = load_project(tmp_path)
    (missing,) = (finding for finding in loaded.diagnostics if finding.rule == "missing-source")
    assert (missing.rule, missing.severity == "error", loaded.partial) == ("missing-source", bool(guess), bool(guess))
    assert missing.help == (f"did you mean `{guess}`?" if guess else "paths are relative to the folder of archgen.yaml")
    assert loaded.lost_keys == (frozenset({"groups", "g", "components", "c"}) if guess else frozenset())
