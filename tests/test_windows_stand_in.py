"""What archgen does where there is less than on Linux: `tests/windows_stand_in.py` takes it away. Windows itself was never seen here."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import unicodedata
from pathlib import Path

import pytest
import yaml

from tests.determined_project import make_every_output_once, make_project, run_every_output
from tests.property_sizes import try_some
from tests.repositories import repository
from tests.running import RAMCIP, ROOT, archgen_here, contents

_STAND_IN = str(ROOT / "tests/windows_stand_in.py")
_TAKE_AWAY = f"exec(open({_STAND_IN!r}, encoding='utf-8').read())"
_RUN_VERBS = "import json, sys; from tests.every_output import call; print(json.dumps([call(each.split()) for each in json.loads(sys.argv[1])]))"


def run_less(code: str, *words: str, cwd: Path, options: tuple[str, ...] = (), **environment: str) -> str:
    """Run a program where less is there; return what it printed."""
    done = subprocess.run(  # noqa: S603 - our own program
        [sys.executable, *options, "-c", f"{_TAKE_AWAY}\n{code}", *words],
        cwd=cwd,
        env={**os.environ, "COLUMNS": "", "PYTHONPATH": str(ROOT), "ARCHGEN_STAND_IN": _STAND_IN, **environment},
        capture_output=True,
        check=False,
        timeout=600,
    )
    assert done.returncode == 0, done.stderr.decode("utf-8", "replace")[-3000:]
    return done.stdout.decode()


def test_it_is_taken_away(tmp_path: Path) -> None:
    attempts = (
        "import fcntl",
        "import resource",
        "os.fork()",
        "os.open('.', os.O_DIRECTORY)",
        "signal.SIGHUP",
        "select.poll()",
        "held = open('a', 'w'); os.replace('b', 'a')",
        "held = open('a', 'w'); os.unlink('a')",
        "os.rename('b', 'c')",
        "os.chmod('c', 0o444); os.replace('b', 'c')",
        "os.path.relpath('b', '/somewhere')",
        "subprocess.run([sys.executable, '-c', 'import fcntl'], check=True, stderr=-3)",
    )
    for name in "bc":
        (tmp_path / name).touch()
    code = "\n".join(f"try:\n    {each}\nexcept Exception as e:\n    print(type(e).__name__)" for each in attempts)
    assert run_less(code, cwd=tmp_path, ARCHGEN_DRIVE=str(tmp_path)).split() == [
        *(
            "ModuleNotFoundError",
            "ModuleNotFoundError",
            "AttributeError",
            "AttributeError",
            "AttributeError",
            "AttributeError",
        ),
        *(
            "PermissionError",
            "PermissionError",
            "FileExistsError",
            "PermissionError",
            "ValueError",
            "CalledProcessError",
        ),
    ]


VERBS = (
    "init {d}/robot --yes",
    "check {d}/robot",
    "check {d}/robot/groups/driving.yaml --format sarif",
    "new component driving.planner -C {d}/robot",
    "rename planner route -C {d}/robot",
    "undo -C {d}/robot",
    "fmt -C {d}/robot",
    "schema {d}/robot -o schema.json",
    "check {d}/robot --update-baseline --baseline known.yaml",
    "check {d}/robot --baseline known.yaml",
    "generate ros2_python -C {d}/robot -o ws",
    "generate ros2_python -C {d}/robot -o ws --check",
    "generate start -C {d}/robot -o ws",
    "export xmi -C {d}/robot -o robot.xmi",
    "import robot.xmi -o {d}/again",
    "build {d}/robot -o out --no-history",
    "build {d}/robot -o out --no-history",
)


@pytest.mark.slow
def test_verbs_with_the_project_on_another_drive(tmp_path: Path) -> None:
    """Each ends with 0; letters beyond Windows-1252, and files without a named encoding, are no trouble either."""
    drive, here = tmp_path / "D", tmp_path / "C"
    drive.mkdir()
    here.mkdir()
    answers = json.loads(
        run_less(
            _RUN_VERBS,
            json.dumps([verb.format(d=drive) for verb in VERBS]),
            cwd=here,
            options=("-X", "warn_default_encoding", "-W", "error::EncodingWarning"),
            ARCHGEN_DRIVE=str(drive),
        )
    )
    assert [(verb, said) for verb, (status, said) in zip(VERBS, answers, strict=True) if status] == []
    assert (here / "out/report.docx").is_file()
    assert (here / "ws/start.sh").is_file()


@pytest.mark.slow
def test_a_merge(tmp_path: Path) -> None:
    text = "archgen: 1\ngroups:\n  g:\n    components:\n      a: {title: A, outputs: {x: T}}\n"
    repository(tmp_path, {"archgen.yaml": text}, day="2026-02-01")
    code = """
import pathlib, subprocess
def git(*words): subprocess.run(["git", "-c", "user.name=a", "-c", "user.email=a@b.c", *words], check=True, capture_output=True)
file = pathlib.Path("archgen.yaml"); text = file.read_text("utf-8")
git("checkout", "-qb", "one"); file.write_text(text + "      b: {title: B, inputs: {x: a.x}}\\n", "utf-8"); git("commit", "-qam", "b")
git("checkout", "-q", "-"); file.write_text(text + "      c: {title: C, inputs: {x: a.x}}\\n", "utf-8"); git("commit", "-qam", "c")
from tests.every_output import call
for words in (["merge-check", "HEAD", "one"], ["diff", "HEAD", "one"], ["review", "--base", "one", "-o", "out"], ["merge", "one"]):
    assert call(words)[0] == 0, call(words)
"""
    run_less(code, cwd=tmp_path)
    merged = (tmp_path / "archgen.yaml").read_text(encoding="utf-8")
    assert "b: {title: B" in merged
    assert "c: {title: C" in merged


@pytest.mark.slow
def test_every_output_is_the_same(tmp_path: Path, tmp_path_factory: pytest.TempPathFactory, worker_id: str) -> None:
    """All that archgen makes, with Graphviz, templates and git in processes that have less, too."""
    python = tmp_path / "python"
    # A program of this name that is Python with less: what is run is `python -c ...`.
    python.write_text(
        f'#!/bin/sh\nshift; code=$1; shift\nexec {sys.executable} -c "$TAKE_AWAY\n$code" "$@"\n', encoding="utf-8"
    )
    python.chmod(0o755)
    environment = {"PYTHONPATH": str(ROOT), "TAKE_AWAY": _TAKE_AWAY, "ARCHGEN_STAND_IN": _STAND_IN}
    made = run_every_output(python, make_project(tmp_path / "robot"), tmp_path / "out", environment)
    assert made == make_every_output_once(tmp_path_factory, worker_id)


def test_what_is_piped_on_windows_is_utf_8(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text("archgen: 1\ngroups: {g: {title: Łódź →}}\n", encoding="utf-8")
    code = "import sys; sys.platform = 'win32'; sys.argv = ['archgen', 'show', 'g', '--format', 'json']; from archgen.__main__ import main; main()"
    said = run_less(
        f"import archgen.cli.show_command, archgen.checking.project_judging, archgen.live\n{code}",
        cwd=tmp_path,
        PYTHONIOENCODING="cp1252",
        PYTHONUTF8="0",
    )
    assert "Łódź →" in said


@pytest.fixture(scope="module")
def checkout_with_crlf(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give the case study as git checks it out where `core.autocrlf` is set."""
    project = tmp_path_factory.mktemp("crlf") / RAMCIP.name
    shutil.copytree(RAMCIP, project, ignore=shutil.ignore_patterns("archgen-out"))
    for file in project.rglob("*"):
        if file.is_file() and b"\0" not in (data := file.read_bytes()):
            file.write_bytes(data.replace(b"\n", b"\r\n"))
    return project


@pytest.mark.parametrize(
    "verb",
    try_some(["check --format json", "list --of connections --format csv", "timing --format json", "pack -o -"]),
)
def test_a_checkout_with_crlf_says_the_same(checkout_with_crlf: Path, verb: str) -> None:
    said = [archgen_here(*verb.split(), cwd=place).stdout for place in (RAMCIP, checkout_with_crlf)]
    assert said[0] == said[1]


@pytest.mark.slow
def test_generated_files_with_crlf_are_still_archgens_own(checkout_with_crlf: Path, tmp_path: Path) -> None:
    words = ("generate", "ros2_python", "-C", checkout_with_crlf, "-o", tmp_path / "ws")
    archgen_here(*words, cwd=tmp_path)
    files = [file for file in (tmp_path / "ws").rglob("*") if file.is_file() and ".archgen" not in file.parts]
    for file in files:
        file.write_bytes(file.read_bytes().replace(b"\n", b"\r\n"))
    archgen_here(*words, "--check", cwd=tmp_path)
    node = next(file for file in files if file.name.endswith("_node.py"))
    node.write_bytes(node.read_bytes() + b"# mine\r\n")
    assert b"was changed by hand" in archgen_here(*words, cwd=tmp_path, status=1).stderr


NAMES = """\
archgen: 1
project: {id: aux, title: "CON: a/b"}
partners: {con: {title: Con}, nul: {title: "Nul."}}
groups:
  con: {owner: con, components: {nul: {outputs: {prn: Aux}}, com1: {inputs: {lpt1: nul.prn}, owner: nul}}}
  LONG: {components: {LONG: {components: {LONG: {components: {LONG: {outputs: {x: "a:b"}}}}}}}}
types: {Aux: std_msgs/msg/Byte, "a:b": std_msgs/msg/Bool, "A:B": std_msgs/msg/Int8}
nodes: {con: {implements: con.nul}, aux: con.com1}
hosts: {nul: , prn: }
views: {con: {show: con}}
use_cases: {CON: {steps: [{from: con.nul, to: con.com1}]}, con: {title: Another one}}
requirements: {AUX: a, aux: b}
"""
_DEVICES = {"con", "prn", "aux", "nul", *(f"{name}{number}" for name in ("com", "lpt") for number in range(10))}


def test_names_that_windows_does_not_take(tmp_path: Path) -> None:
    """Devices, names that differ in case alone, ends in a point, signs, and paths of 260 characters below a home."""
    (tmp_path / "archgen.yaml").write_text(NAMES.replace("LONG", "l" * 64), encoding="utf-8")
    archgen_here("build", "--keep-going", "--backend", "wiki", "--no-history", "-o", "out", cwd=tmp_path)
    archgen_here("build", "--keep-going", "--only", "csv", "-o", "out", cwd=tmp_path)
    paths = list(contents(tmp_path / "out"))
    assert len({path.casefold() for path in paths}) == len(paths)
    parts = {part for path in paths for part in path.split("/")}
    assert [part for part in parts if part.partition(".")[0].lower() in _DEVICES] == []
    assert [part for part in parts if set(part) & set('<>:"|?*\\') or part[-1] in ". "] == []
    assert max(map(len, paths)) <= 160
    assert "diagrams/groups/con_.svg" in paths
    assert 'href="groups/con_.svg"' in (tmp_path / "out/diagrams/overview.svg").read_text(encoding="utf-8")


@pytest.mark.parametrize(("on_disk", "written"), [("NFD", "NFC"), ("NFC", "NFD")])
def test_names_with_accents_in_either_form(tmp_path: Path, on_disk: str, written: str) -> None:
    """As macOS and editors write them."""
    project = 'archgen: 1\nsources: ["gr\u00fcppen/f\u00fc*.yaml", "\u00e4rm.yaml"]\n'
    texts = {"gr\u00fcppen/f\u00fc\u00df.yaml": "a: {outputs: {x: T}}", "\u00e4rm.yaml": "b: {inputs: {x: a.x}}"}
    (tmp_path / "archgen.yaml").write_text(unicodedata.normalize(written, project), encoding="utf-8")  # type: ignore[arg-type]
    for name, text in texts.items():
        file = tmp_path / unicodedata.normalize(on_disk, name)  # type: ignore[arg-type]
        file.parent.mkdir(exist_ok=True)
        file.write_text(f"groups: {{{text[0]}s: {{components: {{{text}}}}}}}\n", encoding="utf-8")
    said = archgen_here("list", cwd=tmp_path).stdout.decode()
    assert "as.a" in said
    assert "bs.b" in said


def test_a_folder_that_is_reached_by_a_link(tmp_path: Path) -> None:
    """`/tmp` of macOS leads to `/private/tmp`."""
    (tmp_path / "private").mkdir()
    (tmp_path / "tmp").symlink_to("private")
    place = tmp_path / "tmp"
    archgen_here("init", place / "robot", "--yes", cwd=tmp_path)
    archgen_here("check", place / "robot" / "groups/driving.yaml", cwd=place)
    archgen_here("fmt", place / "robot" / "groups/driving.yaml", cwd=tmp_path)
    archgen_here("generate", "ros2_python", "-C", place / "robot", "-o", place / "ws", cwd=place)
    archgen_here("new", "component", "driving.planner", "-C", place / "robot", cwd=tmp_path / "private")
    archgen_here("build", place / "robot", "--only", "packed,site", "--no-history", "-o", place / "out", cwd=tmp_path)
    assert (tmp_path / "private/out/site/index.html").is_file()


@pytest.mark.slow
def test_what_the_workflow_does_on_windows_and_macos(tmp_path: Path) -> None:
    """The steps of `ci.yml` as they stand there, but here."""
    workflow = yaml.safe_load((ROOT / ".github/workflows/ci.yml").read_text(encoding="utf-8"))
    (step,) = (each for each in workflow["jobs"]["systems"]["steps"] if each.get("name") == "What a user does first")
    program = tmp_path / "bin/archgen"
    program.parent.mkdir()
    program.write_text(f'#!/bin/sh\nexec {sys.executable} -c "$CODE" "$@"\n', encoding="utf-8")
    program.chmod(0o755)
    environment = {
        "CODE": f"{_TAKE_AWAY}\nfrom archgen.__main__ import main\nmain()",
        "ARCHGEN_STAND_IN": _STAND_IN,
        "PATH": f"{program.parent}:{os.environ['PATH']}",
        "PYTHONPATH": str(ROOT),
        "RUNNER_TEMP": str(tmp_path),
        "GITHUB_WORKSPACE": str(ROOT),
    }
    done = subprocess.run(  # noqa: S603 - what stands in our own file
        ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", step["run"]],  # noqa: S607 - as a runner starts it
        cwd=tmp_path,
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        check=False,
        timeout=900,
    )
    assert done.returncode == 0, done.stdout + done.stderr
