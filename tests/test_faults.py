"""Whatever happens to a verb that writes, each file is old or new, it says so in words, and the next run does its work.

The disk is full or read-only from some step on, or in the midst of a write; the process is killed; files change, vanish or
become something else in the moment in which they are read; two runs write into one place. `make test` tries a step of
some verbs, drawn by their names, the slow tests one of each (`ARCHGEN_FAULT_STEPS=1000` tries each step).
"""

from __future__ import annotations

import os
import random
import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import pytest
import yaml

from tests.fault_injection import READING_KINDS, SIGNALS, Fault, FaultyArchgen, FaultyRun
from tests.property_sizes import DRAWS_ANEW
from tests.repositories import commit, git, repository
from tests.running import ROOT

ROBOT = """\
archgen: 1
project: {id: mini, title: Mini Robot}
ros: {distro: jazzy}
partners: {a: Alpha, b: Beta}
groups:
  sense: {owner: a, components: {lidar: {outputs: {scan: Scan}}, eye: {inputs: {scan: lidar.scan}, outputs: {stop: Stop}}}}
  drive: {owner: b, components: {base: {inputs: {stop: eye.stop}}}}
types: {Scan: {message: sensor_msgs/msg/LaserScan, size: 1 kB}, Stop: {message: std_msgs/msg/Header, size: 40 B}}
nodes:
  lidar_driver: {implements: lidar, host: pc, timing: {rate: 10 Hz, wcet: 5 ms}, publishes: {scan: {topic: /scan}}}
  eye_node: {implements: eye, host: pc, timing: {wcet: 20 ms}, publishes: {stop: {topic: /stop}}}
  base_node: {implements: base, host: pc, timing: {wcet: 1 ms}}
hosts: {pc: {cores: 4}}
chains: {halt: {title: Halt, through: [lidar, eye, base], deadline: 300 ms}}
"""
OLDER = ROBOT.replace("300 ms", "250 ms").replace("Mini", "Maxi")
LAUNCH = '<launch><node pkg="p" exec="e" name="n1"/><node pkg="p" exec="f" name="n2"/></launch>\n'
LATER_LAUNCH = LAUNCH.replace('exec="f" name="n2"', 'exec="g" name="n3"')
REQUIREMENTS = "tests/plugins/reqif/doors.reqif"
FIGURES = "id,rate,wcet\nlidar_driver,10 Hz,4 ms\neye_node,,12 ms\n"
OF_RUNS = re.compile(r"(^|/)(\.archgen-files|\.archgen/[^/]+\.json)$")
"""What says what a run is about to write, and holds the digests of before and after meanwhile."""
UNFINISHED = re.compile(r"(^|/)(\.archgen-new-\w{8}|\.archgen/\w+\.new)/")
"""Where files are made until they are whole: only a run that is killed leaves such a folder, and the next one takes it away."""

Files = dict[str, bytes]


@dataclass(frozen=True)
class Case:
    """A verb, the files that it finds, what runs before it, and the files that are other ones then."""

    words: str
    files: Mapping[str, str]
    before: tuple[str, ...] = ()
    later_files: Mapping[str, str] | None = None
    is_repository: bool = False
    refuses_again: bool = False
    """Whether the verb has nothing to do where it was done already, and says so with an error."""
    is_undone: bool = False
    """Whether a run that was killed half way is taken back by `archgen undo`, and then tried again."""


PLAIN = {"archgen.yaml": ROBOT}
_SECTIONS = yaml.safe_load(ROBOT)
IN_FILES = {
    f"{name}.yaml": yaml.safe_dump({key: _SECTIONS[key] for key in keys}, sort_keys=False)
    for name, keys in {
        "archgen": ("archgen", "project", "ros", "partners"),
        "groups": ("groups", "types"),
        "nodes": ("nodes", "hosts", "chains"),
    }.items()
}
"""The same robot in three files, in block style: what is moved has lines of its own."""
CASES = {
    "pack": Case("pack -o packed.yaml", {"archgen.yaml": OLDER}, ("pack -o packed.yaml",), PLAIN),
    "transform": Case("transform flatten -o flat/archgen.yaml", PLAIN),
    "wiki": Case("build --backend wiki --only wiki", {"archgen.yaml": OLDER}, ("build --only wiki",), PLAIN),
    "build": Case("build", {"archgen.yaml": OLDER}, ("build",), PLAIN),
    "generate": Case("generate start -o ws", PLAIN),
    "generate again": Case("generate start -o ws", {"archgen.yaml": OLDER}, ("generate start -o ws",), PLAIN),
    "diff": Case("diff HEAD~1 HEAD --format html -o diff.html", PLAIN, is_repository=True),
    "review": Case("review --base HEAD~1 -o archgen-out/review", PLAIN, is_repository=True),
    "sign": Case(
        "sign a b --by a Ada --by b Ben --date 2026-03-01 -o signed.md", PLAIN, is_repository=True, refuses_again=True
    ),
    "new": Case("new component sense.nose", PLAIN, refuses_again=True),
    "propose": Case("timing --propose --apply", {"archgen.yaml": "archgen: 1\n"}),
    "adopt": Case(
        "timing --measured run.csv --adopt measured.yaml",
        {"archgen.yaml": ROBOT.replace(", timing: {wcet: 20 ms}", ""), "run.csv": FIGURES},
    ),
    "import": Case("import x.launch.xml -o .", PLAIN | {"x.launch.xml": LAUNCH}, refuses_again=True),
    "import --merge": Case(
        "import x.launch.xml --merge -o .",
        PLAIN | {"x.launch.xml": LAUNCH},
        ("import x.launch.xml -o .",),
        {"x.launch.xml": LATER_LAUNCH},
    ),
    "import reqif": Case("import doors.reqif", PLAIN),
    "init": Case("init robot", {}, refuses_again=True),
    "baseline": Case("check --update-baseline", PLAIN),
    "owners": Case("owners -o CODEOWNERS", PLAIN),
    "schema": Case("schema", PLAIN),
    "merge-driver": Case(
        "merge-driver base.yaml ours.yaml theirs.yaml",
        {"base.yaml": ROBOT, "ours.yaml": ROBOT.replace("Halt", "Hold"), "theirs.yaml": OLDER},
    ),
    "fmt": Case("fmt", {name: text.replace("  ", "    ") for name, text in IN_FILES.items()}),
    "fix": Case("check --fix", IN_FILES | {"nodes.yaml": IN_FILES["nodes.yaml"].replace("host: pc", "Host: pc")}),
    "rename": Case("rename eye watcher", IN_FILES, refuses_again=True, is_undone=True),
    "move": Case("move eye drive", IN_FILES, refuses_again=True, is_undone=True),
    "split": Case("split groups.yaml", IN_FILES, refuses_again=True, is_undone=True),
    "todo": Case("todo --partner b -o todo.md", PLAIN),
    "impact": Case("impact --partner a --format json -o impact.json", PLAIN),
    "generate own code": Case(
        "generate ros2_python -o ws", {"archgen.yaml": OLDER}, ("generate ros2_python -o ws",), PLAIN
    ),
    "simulate": Case("simulate --chain halt --trace late.json", PLAIN),
}
QUICK = ("pack", "new", "import --merge", "merge-driver")
"""Verbs of which `make test` tries some steps, too: they stand for all ways in which files are written but those of generators, which take longest."""


STEPS = int(os.environ.get("ARCHGEN_FAULT_STEPS", "8" if DRAWS_ANEW else "1"))
"""How many steps of each verb the slow tests try with each fault, and `make properties`."""


@pytest.fixture(scope="module")
def faulty() -> Iterator[FaultyArchgen]:
    """Start archgen once for all runs."""
    program = FaultyArchgen()
    yield program
    program.end()


@dataclass(frozen=True)
class Stage:
    """A case that was run once without any fault."""

    faulty: FaultyArchgen
    case: Case
    folder: Path
    done: FaultyRun
    before: Files
    after: Files

    def run(
        self, fault: Fault | None = None, *, anew: bool = True, env: Mapping[str, str | None] | None = None
    ) -> FaultyRun:
        """Run the verb, in a new copy of what it found the first time unless told otherwise."""
        place = self.folder / "robot"
        if anew:
            shutil.rmtree(place, ignore_errors=True)
            shutil.copytree(self.folder / "found", place, symlinks=True)
        return self.faulty.run(*self.case.words.split(), cwd=place, fault=fault, env=env)

    def list_files(self) -> Files:
        """Return what lies in the copy. A tag that a killed run left is nobody's, and the next signature has another one."""
        place = self.folder / "robot"
        return {name: re.sub(rb"(2026\\?-03-01)\.2", rb"\1", data) for name, data in list_files(place).items()}

    def list_finished(self) -> Files:
        """Return what lies in the copy, without what is half done."""
        return {name: data for name, data in self.list_files().items() if not UNFINISHED.search(name)}

    def check_next_run(self) -> None:
        """Find that the next run does all that was to be done, and takes away what was half done."""
        was_done = self.list_finished() == self.after
        if self.case.is_undone and not was_done:
            self.faulty.run("undo", cwd=self.folder / "robot")
            assert self.list_finished() == self.before
        again = self.run(anew=False)
        assert again.status == self.done.status or (self.case.refuses_again and was_done), again
        left = self.list_files()
        assert sorted(left) == sorted(self.after)
        # A document rightly tells of the signature whose tag a killed run left.
        changed = [name for name, data in self.after.items() if left[name] != data]
        assert [name for name in changed if b"**What was signed before**" not in left[name]] == []


def list_files(folder: Path) -> Files:
    """Return what lies below a folder, without git's own."""
    return {
        file.relative_to(folder).as_posix(): f"link to {file.readlink()}".encode()
        if file.is_symlink()
        else file.read_bytes()
        for file in sorted(folder.rglob("*"))
        if ".git" not in file.relative_to(folder).parts and (file.is_symlink() or file.is_file())
    }


@pytest.fixture
def stage(request: pytest.FixtureRequest, faulty: FaultyArchgen, tmp_path: Path) -> Stage:
    """Prepare a case, given by its name."""
    name: str = request.param
    case, found = CASES[name], tmp_path / "found"
    found.mkdir()
    for file, text in case.files.items():
        (found / file).write_text(text, "utf-8")
    if name == "import reqif":
        shutil.copy(ROOT / REQUIREMENTS, found)
    if name == "propose":
        shutil.copy(ROOT / "tests/timing/search/nav_robot.yaml", found / "robot.yaml")
    if case.is_repository:
        repository(found, {"archgen.yaml": OLDER})
        commit(found, {"archgen.yaml": ROBOT})
        git(found, "config", "user.name", "Clerk")
        git(found, "config", "user.email", "clerk@x.org")
    for words in case.before:
        assert faulty.run(*words.split(), cwd=found).status == 0
    for file, text in (case.later_files or {}).items():
        (found / file).write_text(text, "utf-8")
    first = Stage(faulty, case, tmp_path, FaultyRun(0, "", ""), {}, {})
    done = first.run()
    assert done.status == 0, done
    assert done.writing_steps > 0, done
    return Stage(faulty, case, tmp_path, done, list_files(found), first.list_files())


def cases(first: int, *left_out: str) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Give a test a step of a few cases, and more steps in slow tests, which try each case with one fault of three.

    `make properties` tries each with all.
    """
    few = [pytest.param(name, 1, id=name) for name in QUICK]
    marks = (pytest.mark.slow, pytest.mark.hypothesis)
    names = list(CASES) if DRAWS_ANEW else list(CASES)[first::3]
    many = [pytest.param(name, STEPS, id=f"{name}: more", marks=marks) for name in names]
    wanted = [each for each in (*few, *many) if each.values[0] not in left_out]
    return pytest.mark.parametrize(("stage", "count"), wanted, indirect=["stage"])


def draw_steps(stage: Stage, kind: str, last: int, count: int) -> list[int]:
    """Draw steps of a run, the same each time."""
    return sorted(random.Random(f"{stage.case.words} {kind}").sample(range(1, last + 1), min(count, last)))  # noqa: S311


def check_words(ran: FaultyRun) -> None:
    """Find that what was said are words for the user."""
    assert "Traceback" not in ran.err, ran.err
    assert "mistake in archgen" not in ran.err, ran.err
    assert ran.status in {0, 1, 2}, ran
    assert ran.status == 0 or (ran.out if ran.status == 1 else ran.err).strip() or ran.err.strip(), ran


def find_half_files(stage: Stage) -> list[str]:
    """Name the files that are neither as they were nor as they shall be."""
    return [
        name
        for name, data in stage.list_files().items()
        if data not in (stage.before.get(name), stage.after.get(name)) and not OF_RUNS.search(name)
    ]


@cases(0)
def test_a_disk_that_takes_no_more_leaves_files_old_or_new(stage: Stage, count: int) -> None:
    sizes = sorted({len(data) - 1 for name, data in stage.after.items() if data and stage.before.get(name) != data})
    faults = [
        *(Fault("full", step) for step in draw_steps(stage, "full", stage.done.writing_steps, count)),
        *(Fault("denied", step) for step in (1, *draw_steps(stage, "denied", stage.done.writing_steps, count // 2))),
        *(Fault("limit", size) for size in (0, *sizes[-count:])),
    ]
    for fault in faults:
        ran = stage.run(fault)
        check_words(ran)
        left_over = [name for name in find_half_files(stage) if fault.kind != "denied" or not UNFINISHED.search(name)]
        assert left_over == [], fault
        if ran.status == stage.done.status:
            # Only what was to be taken away is still there.
            assert stage.list_finished() == stage.after, fault
        else:
            assert ran.status == 2, (fault, ran)
            assert re.search("No space left|File too large|Read-only file system", ran.err), (fault, ran.err)
            stage.check_next_run()


@cases(1)
def test_a_run_that_is_ended_anywhere_is_no_obstacle(stage: Stage, count: int) -> None:
    for kind in SIGNALS:
        for step in draw_steps(stage, kind, stage.done.writing_steps, count):
            ran = stage.run(Fault(kind, step))
            half_files = find_half_files(stage)
            if kind == "kill":
                assert ran.status == -SIGNALS[kind]
                half_files = [name for name in half_files if not UNFINISHED.search(name)]
            else:
                assert (ran.status, ran.err.splitlines()[-1]) == (128 + SIGNALS[kind], "archgen: stopped"), (kind, step)
            assert half_files == [], (kind, step)
            stage.check_next_run()


@cases(2, "init", "merge-driver")
def test_files_that_change_while_they_are_read_are_told_of(stage: Stage, count: int) -> None:
    for kind in READING_KINDS:
        for step in draw_steps(stage, kind, stage.done.reading_steps, count):
            ran = stage.run(Fault(kind, step))
            check_words(ran)
            told = ran.out + ran.err
            assert "does them harm" not in told, (kind, step)
            assert [name for name, data in stage.list_files().items() if b"does them harm" in data] == [], (kind, step)


@pytest.mark.parametrize(
    "env",
    [
        {"HOME": None, "XDG_CACHE_HOME": None},
        {"HOME": "/nonexistent", "XDG_CACHE_HOME": None, "TMPDIR": "/nonexistent"},
        {"HOME": "/proc", "XDG_CACHE_HOME": "/proc", "TMPDIR": "/proc"},
        {"HOME": "", "XDG_CACHE_HOME": "", "TMPDIR": "", "PATH": None, "USER": None, "LOGNAME": None},
    ],
    ids=["no home", "a home that is not there", "a home that takes nothing", "nothing"],
)
@pytest.mark.parametrize(
    "stage",
    ["pack", "generate", *(pytest.param(each, marks=pytest.mark.slow) for each in ("import --merge", "build", "sign"))],
    indirect=True,
)
def test_neither_a_home_nor_a_place_for_temporary_files_is_needed(stage: Stage, env: dict[str, str | None]) -> None:
    if "PATH" in env and stage.case.is_repository:
        env = {**env, "PATH": os.environ["PATH"]}
    ran = stage.run(env=env)
    assert ran.status == 0, ran
    assert stage.list_files() == stage.after


@pytest.mark.slow
@pytest.mark.parametrize(
    ("words", "target"),
    [("site", "out"), ("generate start", "out"), ("pack", "out.yaml")],
)
def test_two_runs_at_once_leave_what_one_of_them_made(words: str, target: str, tmp_path: Path) -> None:
    def start(project: str, output: Path) -> subprocess.Popen[bytes]:
        command = [sys.executable, "-m", "archgen", *words.split(), "-o", str(output)]
        settings = {**os.environ, "PYTHONPATH": str(ROOT)}
        return subprocess.Popen(command, cwd=tmp_path / project, env=settings, stderr=subprocess.PIPE)  # noqa: S603

    expected = []
    for text, name in ((ROBOT, "first"), (OLDER, "second")):
        (tmp_path / name).mkdir()
        (tmp_path / name / "archgen.yaml").write_text(text, "utf-8")
        alone = start(name, tmp_path / f"{name} alone" / target)
        assert alone.communicate(timeout=600)
        assert alone.returncode == 0
        expected.append(list_files(tmp_path / f"{name} alone"))
    assert expected[0] != expected[1]
    for _ in range(4):
        running = [start(name, tmp_path / "both" / target) for name in ("first", "second")]
        said = [each.communicate(timeout=600) for each in running]
        assert [each.returncode for each in running] == [0, 0], said
        assert list_files(tmp_path / "both") in expected


@pytest.mark.slow
@pytest.mark.parametrize("options", ["size=40k", "size=300k", "ro"])
def test_a_real_disk_that_takes_no_more(options: str, tmp_path: Path) -> None:
    """On a file system of its own, where the tests may mount one."""
    disk = tmp_path / "disk"
    disk.mkdir()
    (disk / "archgen.yaml").write_text(ROBOT, "utf-8")
    script = f"""
        mount -t tmpfs tmpfs "$1" || exit 77
        printf %s "$2" > "$1/archgen.yaml"; cd "$1"
        {"mount -o remount,ro ." if options == "ro" else f"mount -o remount,{options} ."}
        for words in "pack -o packed.yaml" "generate start -o ws" "site -o site" "new group more"; do
            "$0" -m archgen $words; echo "status $?"
        done
        find . -name '.archgen-new-*'; find . -empty -type f
    """
    command = ["unshare", "--mount", "sh", "-c", script, sys.executable, str(disk), ROBOT]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=600)  # noqa: S603
    if done.returncode == 77 or "unshare failed" in done.stderr:
        pytest.skip("who runs the tests may mount nothing")
    assert "Traceback" not in done.stderr
    assert "mistake in archgen" not in done.stderr
    statuses = re.findall(r"^status (\d)$", done.stdout, re.MULTILINE)
    assert len(statuses) == 4
    assert set(statuses) <= {"0", "2"}
    assert statuses.count("2") == len(re.findall("No space left on device|Read-only file system", done.stderr)) > 0
    assert done.stdout.splitlines()[-1].startswith("status")
