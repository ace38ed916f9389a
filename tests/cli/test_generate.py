"""`archgen generate` among files of others: what is refused before anything is written, and what its options do."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tests.cli.conftest import Run
from tests.running import contents

PROJECT = """\
archgen: 1
project: {id: bot}
partners: {certh: {}, acme: {}}
hosts: {arm_pc: {}, base_pc: {}}
types: {Scan: {message: a_msgs/msg/Scan, fields: {x: float64}}, Pose: {message: b_msgs/msg/Pose, fields: {y: float64}}}
groups:
  sensing: {owner: certh, components: {laser: {functionality: Scans., outputs: {scan: Scan}}}}
  moving: {owner: acme, components: {base: {functionality: Moves., inputs: {scan: laser.scan}, outputs: {pose: Pose}}}}
nodes:
  laser: {implements: laser, host: arm_pc}
  base: {implements: base, host: base_pc}
variants:
  quiet: {changes: {types: {Scan: {fields: {x: float32}}}}}
"""
MANIFEST = """\
id: code
title: Code
makes: workspace
emitter: text
view: interfaces
options: {word: hello, nested: {a: b}, shape: [round, square]}
files:
  - {template: t.j2, for_each: interfaces.files, path: "code/{{ item.name }}.txt"}
"""
TEMPLATE = "{{ options.word }} {{ item.name }} {{ item.parts[0].fields[0].spelling }}\n"


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    """Make a project with a generator of its own."""
    folder = tmp_path / "robot"
    (folder / "backends" / "code" / "templates").mkdir(parents=True)
    (folder / "backends" / "code" / "backend.yaml").write_text(MANIFEST)
    (folder / "backends" / "code" / "templates" / "t.j2").write_text(TEMPLATE)
    (folder / "archgen.yaml").write_text(PROJECT)
    return folder


def made(folder: Path) -> dict[str, str]:
    """Return the files that are in a workspace, without archgen's own."""
    return {path: data.decode() for path, data in contents(folder).items() if not path.startswith(".")}


BOTH = {"code/Pose.txt": "hello Pose float64\n", "code/Scan.txt": "hello Scan float64\n"}


def test_a_look_writes_nothing(run: Run, robot: Path, tmp_path: Path) -> None:
    ran = run("generate", "code", "-C", robot, "-o", tmp_path / "ws", "--dry-run")
    assert (ran.status, ran.out, ran.err) == (0, "new      code/Pose.txt\nnew      code/Scan.txt\n", "")
    assert not (tmp_path / "ws").exists()


@pytest.mark.parametrize(
    ("words", "files"),
    [
        (["--select", "owner:certh"], {"code/Scan.txt": "hello Scan float64\n"}),
        (["--host", "arm_pc"], {"code/Scan.txt": "hello Scan float64\n"}),
        (["--host", "base_pc"], BOTH),
        (["--select", "owner:acme", "--host", "arm_pc"], {}),
        (["--option", "word=bye"], {path: text.replace("hello", "bye") for path, text in BOTH.items()}),
        (["--variant", "quiet"], {**BOTH, "code/Scan.txt": "hello Scan float32\n"}),
    ],
)
def test_what_is_asked_for(run: Run, robot: Path, tmp_path: Path, words: list[str], files: dict[str, str]) -> None:
    ran = run("generate", "code", "-C", robot, "-o", tmp_path / "ws", *words)
    assert (ran.status, ran.err) == (0, "")
    assert made(tmp_path / "ws") == files


def test_the_workspace_itself_names_all_of_its_files(run: Run, robot: Path, tmp_path: Path) -> None:
    workspace = tmp_path / "ws"
    run("generate", "code", "-C", robot, "-o", workspace)
    for path in BOTH:
        (workspace / path).write_text("by hand")
    assert run("generate", "code", "-C", robot, "-o", workspace, "--overwrite", workspace).status == 0
    assert made(workspace) == BOTH


def test_parts_are_apart_and_variants_are_not(run: Run, robot: Path, tmp_path: Path) -> None:
    def generate(*words: str) -> str:
        return run("generate", "code", "-C", robot, "-o", tmp_path / "ws", *words).out

    generate("--select", "owner:certh")
    generate("--select", "owner:acme")
    assert generate("--select", "owner:certh", "--variant", "quiet") == f"wrote {tmp_path / 'ws'} (1 changed)\n"
    assert made(tmp_path / "ws") == {**BOTH, "code/Scan.txt": "hello Scan float32\n"}
    (robot / "archgen.yaml").write_text(PROJECT.replace("owner: certh", "owner: acme"))
    # Nothing is certh's any more, and the other run made the same file.
    assert generate("--select", "owner:certh") == f"wrote {tmp_path / 'ws'} (no files)\n"
    assert set(made(tmp_path / "ws")) == set(BOTH)


@pytest.mark.parametrize(
    ("words", "error"),
    [
        (["--host", "arm_cp"], "there is no host 'arm_cp'; did you mean `arm_pc`?"),
        (["--option", "word"], "`--option` takes KEY=VALUE, not 'word'"),
        (["--option", "wrod=x"], "the backend `code` has no option `wrod`; did you mean `word`?"),
        (["--option", "ros=3"], "the backend `code` has no option `ros`"),
        (["--option", "nested=x"], "the backend `code` has no option `nested`; it has word, shape"),
        (
            ["--option", "shape=rond"],
            "the option `shape` of the backend `code` is `round` or `square`, not `rond`; did you mean `round`?",
        ),
        (
            ["--overwrite", "code/Scam.txt"],
            "this backend makes no file `code/Scam.txt` here; did you mean `code/Scan.txt`?",
        ),
        (["--keep", "elsewhere"], "this backend makes no file `elsewhere` here; `--dry-run` shows all files"),
    ],
)
def test_wrong_usage(run: Run, robot: Path, tmp_path: Path, words: list[str], error: str) -> None:
    ran = run("generate", "code", "-C", robot, "-o", tmp_path / "ws", *words)
    assert ran.status == 2
    assert error in ran.err
    assert not (tmp_path / "ws").exists()


def test_a_file_is_no_workspace(run: Run, robot: Path, tmp_path: Path) -> None:
    (tmp_path / "ws").write_text("mine")
    ran = run("generate", "code", "-C", robot, "-o", tmp_path / "ws")
    assert (ran.status, ran.err) == (
        2,
        f"Error: {tmp_path / 'ws'} is a file, not a folder; give another folder with `-o`\n",
    )


def test_a_path_of_another_backend_is_refused(run: Run, robot: Path, tmp_path: Path) -> None:
    other = robot / "backends" / "other"
    (other / "templates").mkdir(parents=True)
    (other / "backend.yaml").write_text(
        MANIFEST.replace("id: code", "id: other").replace("code/{{ item.name }}", "CODE/{{ item.name|lower }}")
    )
    (other / "templates" / "t.j2").write_text(TEMPLATE)
    run("generate", "code", "-C", robot, "-o", tmp_path / "ws")
    before = contents(tmp_path / "ws")
    ran = run("generate", "other", "-C", robot, "-o", tmp_path / "ws")
    assert ran.status == 1
    assert "`CODE/scan.txt` is made by the backend `code` in this folder, and by `other`\n" in ran.err
    assert "\nNothing was written.\n" in ran.err
    assert contents(tmp_path / "ws") == before


def test_two_languages_in_one_package_are_told_with_the_remedy(run: Run, tmp_path: Path) -> None:
    tmp_path.joinpath("archgen.yaml").write_text(
        """\
project: {id: bot}
ros: {distro: jazzy}
generate: {into: ws, backends: {ros2_python: {}, ros2_cpp: {}, ros2_launch: {}}}
groups: {g: {components: {a: {outputs: {x: std_msgs/msg/Bool}}, b: {inputs: {x: a.x}}}}}
nodes: {a: {implements: a, language: python, package: p}, b: {implements: b, language: cpp, package: p}}
"""
    )
    ran = run("generate", "-C", tmp_path)
    assert ran.status == 1
    told = "the package `p` has programs in Python and in C++: `b` and `a`; here it has only those in C++"
    assert told in ran.err
    assert "give the nodes of one language a `package` of their own" in ran.err
    assert "ros2_cpp: nothing was written." in ran.err
    assert (tmp_path / "ws/src/bot_bringup/package.xml").exists()  # what comes after is made


@pytest.mark.parametrize(
    ("path", "error"),
    [
        ("{{ 'x' }}", "`x` (archgen.yaml:5:9) and `x` (archgen.yaml:5:65) fall together: two files of one name"),
        (
            "{{ item.name if item.name == 'Scan' else 'scan' }}",
            "`Scan` (archgen.yaml:5:9) and `scan` (archgen.yaml:5:65) fall together: on many",
        ),
        ("../{{ item.name }}", "`../Pose` (archgen.yaml:5:65) is no path that every system takes"),
        (".git/hooks/{{ item.name }}", "leads into a folder of another tool"),
    ],
)
def test_paths_that_are_refused(run: Run, robot: Path, tmp_path: Path, path: str, error: str) -> None:
    manifest = robot / "backends" / "code" / "backend.yaml"
    manifest.write_text(MANIFEST.replace("code/{{ item.name }}.txt", path))
    ran = run("generate", "code", "-C", robot, "-o", tmp_path / "ws")
    assert ran.status == 2
    assert error in ran.err
    assert not (tmp_path / "ws").exists()


def test_an_empty_path_is_no_file(run: Run, robot: Path, tmp_path: Path) -> None:
    manifest = robot / "backends" / "code" / "backend.yaml"
    manifest.write_text(MANIFEST.replace("code/{{ item.name }}.txt", "{% if item.name == 'Scan' %}one{% endif %}"))
    assert run("generate", "code", "-C", robot, "-o", tmp_path / "ws").status == 0
    assert set(made(tmp_path / "ws")) == {"one"}


def test_needs_that_do_not_hold(run: Run, robot: Path, tmp_path: Path) -> None:
    manifest = robot / "backends" / "code" / "backend.yaml"
    manifest.write_text(f"{MANIFEST}needs: [one_source, unique_names]\n")
    (robot / "archgen.yaml").write_text(
        PROJECT.replace("moving: {", "moving: {")
        .replace("base: {functionality", "laser: {functionality", 1)
        .replace("implements: base", "implements: moving.laser")
        .replace("laser.scan", "sensing.laser.scan")
        .replace("implements: laser,", "implements: sensing.laser,")
    )
    ran = run("generate", "code", "-C", robot, "-o", tmp_path / "ws")
    assert (ran.status, ran.out) == (1, "")
    assert "error[unmet-need]: `sensing.laser` and `moving.laser` are both called `laser`" in ran.err
    assert ran.err.endswith("Nothing was written.\n")
    assert not (tmp_path / "ws").exists()


def test_what_cannot_be_generated_leaves_the_rest(run: Run, robot: Path, tmp_path: Path) -> None:
    (robot / "archgen.yaml").write_text(PROJECT.replace("pose: Pose", "pose: Pose, odd: Strange"))
    ran = run("generate", "code", "-C", robot, "-o", tmp_path / "ws")
    assert ran.status == 1
    assert "error[not-generated]: nobody can generate the type `Strange`" in ran.err
    assert made(tmp_path / "ws") == BOTH


def test_programs_and_assets(run: Run, robot: Path, tmp_path: Path) -> None:
    folder = robot / "backends" / "code"
    (folder / "backend.yaml").write_text(MANIFEST.replace('.txt"}', '.txt", executable: true}'))
    (folder / "assets" / "Lib").mkdir(parents=True)
    (folder / "assets" / "Lib" / "Help.py").write_text("pass\n")
    assert run("generate", "code", "-C", robot, "-o", tmp_path / "ws").status == 0
    assert made(tmp_path / "ws") == {"Lib/Help.py": "pass\n", **BOTH}
    assert os.access(tmp_path / "ws" / "code" / "Scan.txt", os.X_OK)


@pytest.mark.parametrize(
    ("key", "error"),
    [
        ("makes: documents\npasses: [flatten]", "`passes` goes with `makes: workspace`"),
        ("makes: documents\nneeds: [flat]", "`needs` goes with `makes: workspace`"),
    ],
)
def test_keys_of_workspaces(run: Run, robot: Path, key: str, error: str) -> None:
    (robot / "backends" / "code" / "backend.yaml").write_text(MANIFEST.replace("makes: workspace", key))
    ran = run("generate", "code", "-C", robot)
    assert ran.status == 2
    assert error in ran.err


def test_passes_run_before(run: Run, robot: Path, tmp_path: Path) -> None:
    manifest = robot / "backends" / "code" / "backend.yaml"
    folder = robot / "backends" / "code"
    manifest.write_text(
        MANIFEST.replace(
            "view: interfaces", "view: [interfaces, record]\npasses: [remove_generics]\nneeds: [no_generics]"
        ).replace('for_each: interfaces.files, path: "code/{{ item.name }}.txt"', "path: types.txt")
    )
    (folder / "templates" / "t.j2").write_text("{{ record.types|list|join(',') }}\n")
    generic = "types: {Box: {generic: [T], fields: {x: T}}, "
    (robot / "archgen.yaml").write_text(
        PROJECT.replace("types: {", generic).replace("pose: Pose}", "pose: Pose, box: Box<Pose>}")
    )
    ran = run("generate", "code", "-C", robot, "-o", tmp_path / "ws", "--select", "owner:acme")
    assert (ran.status, ran.err) == (0, "")
    assert "<" not in made(tmp_path / "ws")["types.txt"]
    manifest.write_text(manifest.read_text().replace("remove_generics", "remove_generic"))
    ran = run("generate", "code", "-C", robot, "-o", tmp_path / "ws")
    assert ran.status == 2
    assert (
        "the backend `code` cannot be used: no pass named `remove_generic`: did you mean `remove_generics`?" in ran.err
    )


LISTED = "generate:\n  into: ws\n  backends: {code: {word: listed}, ros_interfaces: }\n"


def test_all_that_is_listed_is_made(run: Run, robot: Path) -> None:
    (robot / "archgen.yaml").write_text(PROJECT + LISTED)
    ran = run("generate", "--check", "-C", robot)
    assert (ran.status, ran.out.splitlines()[0]) == (1, "stale: code/Pose.txt (it is not there)")
    assert not (robot / "ws").exists()
    ran = run("generate", "-C", robot)
    assert (ran.status, ran.err) == (0, "")
    files = made(robot / "ws")
    assert files["code/Scan.txt"] == "listed Scan float64\n"
    assert "src/a_msgs/msg/Scan.msg" in files
    ran = run("generate", "--check", "-C", robot)
    assert (ran.status, ran.out, ran.err) == (0, "", "")
    # What the project lists counts for a backend alone, too; what somebody says now counts more.
    assert run("generate", "code", "--check", "-C", robot).status == 0
    assert run("generate", "code", "--check", "-C", robot, "--option", "word=other").status == 1
    (robot / "archgen.yaml").write_text(PROJECT.replace("x: float64", "x: float32") + LISTED)
    ran = run("generate", "--check", "-C", robot)
    assert ran.out.splitlines() == [
        "stale: code/Scan.txt (it is not as the model says)",
        "stale: src/a_msgs/msg/Scan.msg (it is not as the model says)",
    ]
    assert made(robot / "ws") == files


@pytest.mark.parametrize(
    ("listed", "words", "message"),
    [
        ("", (), "name what to make: "),
        ("generate: {backends: {}}", (), "or list what to make in `generate` of the project"),
        ("generate: {into: ../../x, backends: {code: }}", (), "leads out of the project's repository"),
        ("generate: {into: /tmp/x, backends: {code: }}", ("code",), "leads out of the project's repository"),
        (LISTED, ("--option", "word=a"), "want the backend that they are for"),
        (LISTED, ("--keep", "x"), "want the backend that they are for"),
        ("generate: {backends: {cde: }}", (), "there is no text backend `cde`"),
        ("generate: {backends: {code: {wrd: a}}}", (), "the backend `code` has no option `wrd`"),
        ("generate: [code]", (), "generate"),
    ],
)
def test_what_cannot_be_made_is_refused(
    run: Run, robot: Path, listed: str, words: tuple[str, ...], message: str
) -> None:
    (robot / "archgen.yaml").write_text(PROJECT + listed)
    ran = run("generate", *words, "-C", robot)
    assert ran.status in {1, 2}
    assert message in ran.err
    assert not (robot / "archgen-out").exists()


def test_other_ends_of_lines_are_no_edit(run: Run, robot: Path, tmp_path: Path) -> None:
    """Git and editors of Windows write them."""
    run("generate", "code", "-C", robot, "-o", tmp_path / "ws")
    file = tmp_path / "ws" / "code" / "Scan.txt"
    file.write_bytes(file.read_bytes().replace(b"\n", b"\r\n"))
    assert run("generate", "code", "-C", robot, "-o", tmp_path / "ws", "--check").status == 0


def test_a_link_is_told_once(run: Run, robot: Path, tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "ws").mkdir()
    (tmp_path / "ws" / "code").symlink_to(tmp_path / "elsewhere")
    ran = run("generate", "code", "-C", robot, "-o", tmp_path / "ws")
    assert ran.status == 1
    assert ran.err.count("`code` is a link") == 1
    assert "(1 more for the same reason)" in ran.err


def test_a_backend_that_is_listed_no_more_is_told(run: Run, robot: Path, tmp_path: Path) -> None:
    project = robot / "archgen.yaml"
    text = project.read_text()
    project.write_text(text + "generate: {backends: {code: }}\n")
    assert not run("generate", "-C", robot, "-o", tmp_path / "ws").err
    project.write_text(text + "generate: {backends: {start: }}\n")
    ran = run("generate", "-C", robot, "-o", tmp_path / "ws")
    assert "has files of the backend `code`, which `generate` does not list" in ran.err


def test_what_was_seen_of_a_robot_is_no_record_of_a_backend(run: Run, robot: Path) -> None:
    (robot / ".archgen").mkdir()
    (robot / ".archgen" / "conform.json").write_text('{"archgen": 1, "robots": {}}')
    assert run("generate", "code", "-C", robot, "-o", robot).status == 0
