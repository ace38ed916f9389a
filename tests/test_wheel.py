"""The wheel: it holds all that archgen needs and nothing else, and works away from the checkout.

Nothing is downloaded: the wheel is built by the backend that is installed here, and its fresh environment finds the
libraries that archgen stands on in this one, by a .pth file.
"""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
import sysconfig
import tarfile
import venv
import zipfile
from collections.abc import Iterator
from pathlib import Path

import pytest

from archgen import __version__
from tests.determined_project import make_project, run_every_output
from tests.running import REVISION, ROOT, contents, made_once

pytestmark = pytest.mark.build
NAME = f"archgen-{__version__}"
DATA = ("backends", "schemas", "start", "passes", "docs/rules", "example_ramcip", "ros_library", "ros_type_mapper.yaml")
LEFT_OUT = {"__pycache__", "archgen-out"}


def run(*words: str | Path, cwd: Path, status: int = 0) -> str:
    """Run a command without this checkout on Python's path."""
    environment = {key: value for key, value in os.environ.items() if not key.startswith("PYTHON")}
    environment["XDG_CACHE_HOME"] = str(cwd / "cache")
    done = subprocess.run(  # noqa: S603 - our own program
        [*map(str, words)], cwd=cwd, env=environment, capture_output=True, check=False, timeout=600
    )
    assert done.returncode == status, done.stdout.decode()[-3000:] + done.stderr.decode()[-3000:]
    return done.stdout.decode()


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory, worker_id: str) -> Path:
    """Build the sdist, and the wheel from it; give their folder."""
    base = tmp_path_factory.getbasetemp()
    place = base if worker_id == "master" else base.parent

    def make(folder: Path) -> None:
        run(sys.executable, "-m", "build", "--no-isolation", "--outdir", folder, ROOT, cwd=place)

    return made_once(place / "dist", make)


@pytest.fixture(scope="module")
def installed(built: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Install the wheel in a fresh environment; give the folder of its programs."""
    place = tmp_path_factory.mktemp("environment") / "venv"
    venv.create(place, symlinks=True)
    python = place / "bin" / "python"
    wheel = built / f"{NAME}-py3-none-any.whl"
    pip = (sys.executable, "-m", "pip", "--python", python, "install", "--no-index", "--no-deps", "--quiet", wheel)
    run(*pip, cwd=place)
    site = run(python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))", cwd=place).strip()
    shared = dict.fromkeys((sysconfig.get_path("purelib"), sysconfig.get_path("platlib")))
    (Path(site) / "libraries_of_the_tests.pth").write_text("".join(f"{path}\n" for path in shared))
    return place / "bin"


def below(folder: Path) -> Iterator[str]:
    """Name every file of the checkout in a folder, or the file."""
    found = folder.rglob("*") if folder.is_dir() else [folder]
    for file in found:
        path = file.relative_to(ROOT)
        if file.is_file() and not LEFT_OUT & set(path.parts):
            yield path.as_posix()


def test_the_wheel_holds_what_archgen_needs_and_nothing_else(built: Path) -> None:
    with zipfile.ZipFile(built / f"{NAME}-py3-none-any.whl") as wheel:
        held = set(wheel.namelist())
    about = {name.partition("/")[2] for name in held if name.startswith(f"{NAME}.dist-info/")}
    licences = {
        "LICENSE",
        "archgen/emit/docx/fonts/LICENSE.DejaVu",
        "archgen/emit/fonts/LICENSE.DejaVu",
        "archgen/emit/fonts/LICENSE.Inter",
        "backends/site/assets/fonts/LICENSE-Inter.txt",
        "backends/site/assets/search/LICENSE-uFuzzy.txt",
    }
    assert about == {"METADATA", "RECORD", "WHEEL", "entry_points.txt", *(f"licenses/{name}" for name in licences)}
    data = {f"archgen/_data/{path}" for name in DATA for path in below(ROOT / name)}
    expected = {*below(ROOT / "archgen"), *data}
    assert sorted(held - {f"{NAME}.dist-info/{name}" for name in about} - expected) == []
    assert sorted(expected - held) == []


@pytest.mark.slow
def test_two_builds_make_the_same_bytes(tmp_path: Path) -> None:
    """By `make dist`, from two clones in other folders, with files of other times and permissions, at other times."""
    digests = []
    for name, umask in (("one", 0o022), ("zwei Ö", 0o077)):
        clone, old = tmp_path / name / "archgen", os.umask(umask)
        try:
            subprocess.run(["git", "clone", "--quiet", ROOT, clone], check=True)  # noqa: S603, S607
            for number, file in enumerate(sorted(clone.rglob("*.py"))):
                os.utime(file, (number * 1_000_000, number * 1_000_000))
            (clone / "archgen" / "left_over.py").write_text("not committed = 1\n")
            (clone / ".make").mkdir()
            (clone / ".make" / "test").touch()
            (clone / ".venv").symlink_to(Path(sys.executable).parents[1])
            run("make", "dist", "--old-file=.make/test", cwd=clone)
        finally:
            os.umask(old)
        digests.append(
            {file.name: hashlib.sha256(file.read_bytes()).hexdigest() for file in (clone / "dist").iterdir()}
        )
    assert digests[0] == digests[1]
    assert sorted(digests[0]) == [f"{NAME}-py3-none-any.whl", f"{NAME}.tar.gz"]
    with zipfile.ZipFile(tmp_path / "one" / "archgen" / "dist" / f"{NAME}-py3-none-any.whl") as wheel:
        assert "archgen/left_over.py" not in wheel.namelist()
        committed = run("git", "log", "-1", "--format=%cd", "--date=format:%Y", cwd=ROOT)
        assert {member.date_time[0] for member in wheel.infolist()} == {int(committed)}


@pytest.mark.parametrize(
    "name",
    [
        "py.typed",
        "_data/schemas/archgen.schema.json",
        "_data/backends/report/template/word/styles.xml",
        "_data/backends/wiki/templates/home.md.j2",
        "_data/docs/rules/unread-output.md",
        "_data/ros_library/distributions.yaml",
        "_data/ros_library/ros_2.yaml",
        "_data/ros_library/sources/jazzy.yaml",
        "_data/ros_type_mapper.yaml",
        "_data/start/archgen.yaml.j2",
        "_data/start/gitattributes",
        "_data/example_ramcip/archgen.yaml",
        "emit/fonts/DejaVuSans.ttf",
        "emit/fonts/LICENSE.DejaVu",
        "emit/docx/fonts/DejaVuSansMono.ttf",
        "_data/backends/site/assets/fonts/LICENSE-Inter.txt",
        "_data/backends/site/assets/search/LICENSE-uFuzzy.txt",
        "_data/backends/site/assets/search/ufuzzy.js",
        "link/ros_interfaces/jazzy.names.json",
    ],
)
def test_the_wheel_holds(name: str, built: Path) -> None:
    with zipfile.ZipFile(built / f"{NAME}-py3-none-any.whl") as wheel:
        assert wheel.getinfo(f"archgen/{name}").file_size > 0 or name == "py.typed"


def test_the_sdist_holds_the_tests_and_no_outputs(built: Path) -> None:
    with tarfile.open(built / f"{NAME}.tar.gz") as sdist:
        held = {name.partition("/")[2] for name in sdist.getnames()}
    assert {"tests/test_wheel.py", "Makefile", "docs/language.md", "LICENSE"} <= held
    assert [name for name in held if LEFT_OUT & set(name.split("/"))] == []


def test_it_says_its_version(installed: Path, tmp_path: Path) -> None:
    said = run(installed / "archgen", "--version", cwd=tmp_path).splitlines()
    assert said[0] == f"archgen {__version__}"
    assert [line for line in said if "not installed" in line] == []


def test_it_makes_the_case_study_as_the_checkout_does(installed: Path, ramcip: Path, tmp_path: Path) -> None:
    where = "from archgen import resources; print(resources.resource_path('example_ramcip'))"
    example = run(installed / "python", "-c", where, cwd=tmp_path).strip()
    assert Path(example).is_relative_to(installed.parent)
    run(installed / "archgen", "check", example, cwd=tmp_path)
    run(
        installed / "archgen",
        "build",
        example,
        "--backend",
        "wiki",
        "--revision",
        REVISION,
        "--no-history",
        "-o",
        "out",
        cwd=tmp_path,
    )
    made, expected = contents(tmp_path / "out"), contents(ramcip)
    assert sorted(made) == sorted(expected)
    assert [path for path, data in expected.items() if made[path] != data] == []


def test_it_makes_every_output_as_the_checkout_does(installed: Path, tmp_path: Path) -> None:
    made = list[dict[str, bytes]]()
    for python, path in ((installed / "python", ""), (Path(sys.executable), str(ROOT))):
        place = tmp_path / f"{len(made)}"
        settings = {"PYTHONPATH": path, "XDG_CACHE_HOME": str(place / "cache")}
        made.append(run_every_output(python, make_project(place / "robot"), place / "out", settings))
    assert sorted(made[0]) == sorted(made[1])
    assert [name for name, data in made[1].items() if made[0][name] != data] == []


def test_it_explains_rules_and_starts_projects(installed: Path, tmp_path: Path) -> None:
    assert run(installed / "archgen", "explain", "unread-output", cwd=tmp_path).startswith("unread-output (warning)")
    run(installed / "archgen", "init", "robot", cwd=tmp_path)
    run(installed / "archgen", "check", "--strict", "robot", cwd=tmp_path)
    assert (tmp_path / "robot" / ".vscode" / "archgen.schema.json").stat().st_size > 10_000


def test_it_runs_as_a_module_and_has_types(installed: Path, tmp_path: Path) -> None:
    assert "Usage: archgen" in run(installed / "python", "-m", "archgen", "--help", cwd=tmp_path)
    (tmp_path / "user.py").write_text("import archgen\n\ncount: str = archgen.load('.').size.components\n")
    said = run(installed / "python", "-m", "mypy", "--cache-dir", "mypy", "user.py", cwd=tmp_path, status=1)
    assert 'expression has type "int", variable has type "str"' in said
