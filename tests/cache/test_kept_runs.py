"""A kept run is repeated while nothing that it asked for has changed, and whatever stands in the cache does no more."""

from __future__ import annotations

import io
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from archgen import cache
from archgen.cache import find_cache_path, kept_runs
from archgen.cache.kept_runs import RunKeeper
from archgen.git.git_call import ask_git, run_git
from tests.measured_project import PROJECT

pytestmark = pytest.mark.skipif(sys.version_info >= (3, 13), reason="nothing is kept there")
_SLICE = "groups: {g: {components: {c: {outputs: {o: T}}}}}\n"


@pytest.fixture(autouse=True)
def _empty_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setattr(cache, "KEPT_VERBS", ("check", "generate", "build"))
    monkeypatch.setattr(kept_runs, "SETTLED_NANOSECONDS", -10_000_000)
    # The code of this process is more than that of any run.
    monkeypatch.setattr(kept_runs, "_list_code", lambda: {("bytes", "toy.py"): ""})
    place = tmp_path / "place"
    place.mkdir()
    monkeypatch.chdir(place)
    yield
    assert os.stat is kept_runs._STAT  # noqa: SLF001 - nothing is left behind


def _run(ask: Callable[[], object], words: tuple[str, ...] = ("check",)) -> bool:
    """Let something ask the disk in a run; return whether it was repeated instead."""
    keeper = RunKeeper(words, ask_git)
    if keeper.repeat() is not None:
        return True
    keeper.start_noting()
    try:
        sys.stdout.write(f"{ask()}\n")
    finally:
        keeper.keep(0)
    return False


def _read_all(folder: Path) -> str:
    return " ".join(path.read_text() for path in sorted(folder.iterdir()))


_QUESTIONS: dict[str, tuple[Callable[[], object], Callable[[], object]]] = {
    "a file is written": (lambda: Path("a/x").read_text(), lambda: Path("a/x").write_text("new")),
    "a file is as long as before": (lambda: Path("a/x").read_text(), lambda: Path("a/x").write_text("dlo")),
    "a file appears": (lambda: Path("a/new").exists(), lambda: Path("a/new").write_text("")),
    "a file goes": (lambda: os.path.isfile("a/x"), lambda: Path("a/x").unlink()),  # noqa: PTH113 - as archgen asks
    "a file that could not be read appears": (
        lambda: _try_to_read("b/x"),
        lambda: shutil.copytree("a", "b"),
    ),
    "a folder has one more": (lambda: os.listdir("a"), lambda: Path("a/new").write_text("")),  # noqa: PTH208 - the same
    "a folder that is walked has one more below": (lambda: [*os.walk(".")], lambda: Path("a/c/new").write_text("")),
    "a file is moved": (lambda: [*os.walk(".")], lambda: Path("a/x").rename("a/c/x")),
    "a link leads elsewhere": (
        lambda: os.path.realpath("link"),
        lambda: Path("other").replace("link"),
    ),
    "a link gets its target": (lambda: Path("dangling").exists(), lambda: Path("nowhere").write_text("")),
    "rights change": (lambda: os.access("a/x", os.W_OK), lambda: Path("a/x").chmod(0o400)),
    "a folder is exchanged": (
        lambda: Path("a").stat().st_ino,
        lambda: (Path("a").rename("old"), shutil.copytree("old", "a")),
    ),
    "the code changes": (lambda: 1, lambda: Path("toy.py").write_text("A = 1")),
    "the surroundings change": (lambda: os.environ.get("TOY"), lambda: os.environ.update(TOY="1")),
}


def _try_to_read(name: str) -> str:
    try:
        return Path(name).read_text()
    except OSError:
        return ""


@pytest.mark.parametrize("change", _QUESTIONS)
def test_what_was_asked_and_changed_is_noticed(change: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("TOY", raising=False)
    Path("a/c").mkdir(parents=True)
    Path("a/x").write_text("old")
    Path("link").symlink_to("a")
    Path("other").symlink_to("a/c")
    Path("dangling").symlink_to("nowhere")
    Path("toy.py").write_text("")
    ask, plant = _QUESTIONS[change]
    assert not _run(ask)
    assert _run(ask)
    monkeypatch.setenv("TOY", os.environ.get("TOY", ""))
    monkeypatch.delenv("TOY")
    plant()
    assert not _run(ask)


@pytest.mark.parametrize(
    "act",
    [
        lambda: Path("made").write_text("x"),
        lambda: os.waitpid(os.posix_spawn("/bin/true", ["true"], {}), 0),
        # This process has loaded `subprocess` before.
        lambda: subprocess.run(["/bin/true"], check=True, close_fds=True, cwd="."),
        lambda: os.rename("a", "b"),  # noqa: PTH104
        lambda: os.remove("a"),  # noqa: PTH107
        lambda: os.stat("a", dir_fd=os.open(".", os.O_RDONLY)),
        lambda: "\x1b]0;title\x07",
    ],
    ids=[
        "writes",
        "starts a process",
        "starts a process as git is started",
        "renames",
        "removes",
        "asks below an open folder",
        "rules the terminal",
    ],
)
def test_a_run_that_does_more_than_read_is_not_kept(act: Callable[[], object]) -> None:
    Path("a").write_text("")
    assert not _run(act)
    Path("a").write_text("")
    assert not _run(act)


def test_a_run_whose_file_changes_meanwhile_is_not_kept() -> None:
    Path("a").write_text("old")

    keeper = RunKeeper(["check"], ask_git)
    keeper.start_noting()
    Path("a").read_text()
    keeper._is_noting = False  # noqa: SLF001 - another process writes
    Path("a").write_text("new")
    keeper.keep(0)
    assert RunKeeper(["check"], ask_git).repeat() is None


def test_what_changed_just_before_is_not_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kept_runs, "SETTLED_NANOSECONDS", 2_000_000_000)
    Path("a").write_text("old")
    assert not _run(lambda: Path("a").read_text())
    assert not _run(lambda: Path("a").read_text())


@pytest.mark.parametrize(
    "damage",
    [
        lambda _: b"",
        lambda data: data[: len(data) // 2],
        lambda _: b"[" * 100_000,
        lambda _: b'{"status": 0, "said": 5, "asked": []}',
        lambda _: b'{"status": 0, "said": [], "asked": [["bytes", "a\\u0000", "x"]]}',
        lambda _: b'{"status": 0, "said": [], "asked": [["bytes", "/dev/zero", "x"], ["names", 7, "x"]]}',
        lambda _: b'{"status": [], "said": [], "asked": []}',
        lambda _: b'{"status": 7, "said": [], "asked": []}',
        lambda _: json.dumps({"status": 0, "said": [[1, "\x1b]0;title\x07"]], "asked": []}).encode(),
        lambda _: json.dumps({"status": 0, "said": [[1, "\ud800"]], "asked": []}).encode(),
    ],
)
def test_what_was_done_to_the_cache_is_a_run_that_is_made(
    damage: Callable[[bytes], bytes], capsys: pytest.CaptureFixture[str]
) -> None:
    Path("a").write_text("old")
    assert not _run(lambda: Path("a").read_text())
    (file,) = Path(find_cache_path() or "").glob("*.run")
    file.write_bytes(damage(file.read_bytes()))
    capsys.readouterr()
    assert not _run(lambda: Path("a").read_text())
    assert capsys.readouterr().out == "old\n"


def test_what_others_can_write_is_not_repeated() -> None:
    assert not _run(lambda: 1)
    (file,) = Path(find_cache_path() or "").glob("*.run")
    file.chmod(0o666)
    assert not _run(lambda: 1)


def _archgen(*words: str, settled: int = -10_000_000) -> tuple[bool, int, bytes]:
    """Run archgen in a process; return whether it was repeated, its exit status and what it says."""
    script = f"""if True:
        import sys
        from archgen.cache import kept_runs
        kept_runs.SETTLED_NANOSECONDS = {settled}
        from archgen.__main__ import main
        try:
            main()
        finally:
            sys.__stderr__.write("made" * ("click" in sys.modules))
    """
    # Both streams in one: their order is kept, too.
    done = subprocess.run(  # noqa: S603 - this Python
        [sys.executable, "-c", script, *words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False
    )
    return not done.stdout.endswith(b"made"), done.returncode, done.stdout.removesuffix(b"made")


@pytest.mark.slow
@pytest.mark.parametrize("words", [("check",), ("generate", "ros2_launch", "-o", "out")])
def test_all_that_python_tells_of_the_disk_was_noted(words: tuple[str, ...]) -> None:
    Path("archgen.yaml").write_text(PROJECT)
    _archgen(*words)
    script = """if True:
        import os, sys
        told = []
        sys.addaudithook(lambda event, arguments: told.append((event, arguments)))
        from archgen.cache import kept_runs
        kept_runs.SETTLED_NANOSECONDS = -10_000_000
        from archgen.__main__ import main
        keep = kept_runs.RunKeeper.keep
        def compare(keeper, status):
            noted = {os.path.realpath(path) for kind, path in list(keeper._asked)}
            for event, arguments in [*told]:
                if event in {"open", "os.listdir", "os.scandir"} and isinstance(arguments[0], str):
                    # Of what is installed, imports are questions about code.
                    is_code = arguments[0].endswith((".pyc", ".py", ".so", ".run")) or arguments[0] in sys.path
                    if not is_code and os.path.realpath(arguments[0]).startswith(os.getcwd()):
                        assert os.path.realpath(arguments[0]) in noted, arguments
                else:
                    assert not event.startswith(("subprocess", "socket.connect", "os.fork", "os.exec", "os.spawn")), event
            keep(keeper, status)
            assert os.path.exists(keeper._path)
        kept_runs.RunKeeper.keep = compare
        main()
    """
    command = [sys.executable, "-c", script, *words]
    done = subprocess.run(command, capture_output=True, check=False, text=True)  # noqa: S603 - this Python
    assert "archgen: failed" not in done.stderr
    assert done.returncode in {0, 1}


def test_a_check_says_the_same_again_until_a_file_changes() -> None:
    Path("groups").mkdir()
    Path("archgen.yaml").write_text("project: {id: toy, title: Toy}\nsources: [groups/*.yaml]\n")
    Path("groups/g.yaml").write_text(_SLICE)
    first = _archgen("check")
    assert not first[0]
    assert _archgen("check") == (True, *first[1:])
    warned = _archgen("check", "--strict", "-q")
    assert not warned[0]
    assert b"not shown: 1 note" in warned[2]
    assert _archgen("check", "--strict", "-q") == (True, *warned[1:])
    for plant in (
        lambda: Path("groups/h.yaml").write_text(_SLICE.replace("g:", "h:").replace("c:", "d:")),
        lambda: Path("groups/g.yaml").write_text("groups: 5\n"),
        lambda: Path("groups/h.yaml").unlink(),
    ):
        plant()
        is_repeated, *said = _archgen("check")
        assert not is_repeated
        assert _archgen("check") == (True, *said)


@pytest.mark.slow
def test_a_second_generate_says_the_same_again_until_a_made_file_changes() -> None:
    Path("archgen.yaml").write_text(PROJECT)
    assert not _archgen("generate", "ros2_launch", "-o", "out")[0]
    second = _archgen("generate", "ros2_launch", "-o", "out")
    assert not second[0]
    assert _archgen("generate", "ros2_launch", "-o", "out") == (True, *second[1:])
    made = next(path for path in sorted(Path("out").rglob("*")) if path.is_file() and ".archgen" not in path.parts)
    made.write_text("by hand")
    assert not _archgen("generate", "ros2_launch", "-o", "out")[0]


def _git(*words: str) -> None:
    person = ("-c", "user.name=a", "-c", "user.email=a@example.com")
    subprocess.run(["git", *person, *words], check=True, capture_output=True)  # noqa: S603, S607 - git of the path


def test_a_build_says_the_same_again_until_an_output_changes() -> None:
    Path("archgen.yaml").write_text(PROJECT)
    _git("init", "-q")
    _git("add", "archgen.yaml")
    _git("commit", "-qm", "one")
    words = ("build", "-o", "out", "--only", "packed")
    # The second one finds a new file in the folder of the project, and the stamp that the first one left.
    *_, last = _archgen(*words), _archgen(*words), _archgen(*words)
    assert not last[0]
    assert _archgen(*words) == (True, *last[1:])
    Path("out/packed.yaml").unlink()
    assert not _archgen(*words)[0]
    assert Path("out/packed.yaml").is_file()


def test_git_is_asked_again_for_nothing_but_commits_of_files() -> None:
    _git("init", "-q")
    plain = ("rev-parse", "--verify", "--quiet", "--end-of-options", "HEAD")

    def ask() -> None:
        run_git(Path(), *plain)

    assert not _run(ask)
    assert _run(ask)
    _git("commit", "-q", "--allow-empty", "-m", "one")
    assert not _run(ask)
    record = next(Path(find_cache_path() or "").glob("*.run"))
    record.write_text(record.read_text().replace(plain[1], "--output=made"))
    assert not _run(ask)
    assert not Path("made").exists()
    assert not _run(lambda: run_git(Path(), "log", "--oneline"), ("generate",))
    assert not _run(lambda: run_git(Path(), "log", "--oneline"), ("generate",))


def test_a_run_that_fails_leaves_nothing_replaced(monkeypatch: pytest.MonkeyPatch) -> None:
    """What it said last, without an end of the line, is said."""
    keeper = RunKeeper(["check"], ask_git)
    said = io.TextIOWrapper(io.BytesIO(), line_buffering=True)
    monkeypatch.setattr(sys, "stderr", said)
    keeper.start_noting()
    sys.stderr.write("no end")
    keeper.stop_noting()
    assert sys.stderr is said
    assert said.buffer.getvalue() == b"no end"


def test_what_is_loaded_while_a_run_is_noted_removes_folders_as_safely_as_ever() -> None:
    """`shutil` looks when it is loaded whether the system can look at files below a folder that is open."""
    code = (
        "from archgen.__main__ import _start_keeping; import os, sys; stat = os.stat; sys.argv = ['archgen', 'check'];"
        "_start_keeping(); assert os.stat is not stat; assert 'shutil' not in sys.modules;"
        "import shutil; assert shutil.rmtree.avoids_symlink_attacks"
    )
    subprocess.run([sys.executable, "-c", code], check=True)  # noqa: S603 - our own interpreter and code
