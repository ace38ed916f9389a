"""Writing into a folder that holds other people's files: whose each is, and what an interruption at any step leaves."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from collections.abc import Callable, Iterable, Iterator
from functools import partial
from pathlib import Path

import pytest

from archgen.emit import file_tree
from archgen.emit.file_tree import OutputError
from archgen.emit.workspace import workspace_writing
from archgen.emit.workspace.disk_files import DiskReader, GeneratedFile, find_path_problems
from archgen.emit.workspace.run_record import read_other_records, read_run_record, write_run_record
from archgen.emit.workspace.workspace_plan import UserChoices, WorkspacePlan, plan_workspace
from tests.running import contents

NO_CHOICES = UserChoices()


def files(**texts: str) -> list[GeneratedFile]:
    """Make files by path, with `__` for a slash."""
    return [GeneratedFile(path.replace("__", "/"), text.encode()) for path, text in texts.items()]


def generate(
    folder: Path,
    made: Iterable[GeneratedFile],
    run: str = "robot",
    backend: str = "code",
    choices: UserChoices = NO_CHOICES,
) -> WorkspacePlan:
    """Write files as a run of a backend does."""
    with workspace_writing.lock_workspace(folder):
        plan = plan_workspace(read_run_record(folder, backend), run, made, DiskReader(folder), choices)
        workspace_writing.carry_out(plan, folder)
    return plan


def verbs(plan: WorkspacePlan) -> dict[str, str]:
    return {step.path: step.verb for step in plan.steps}


def texts(folder: Path) -> dict[str, str]:
    """Return what stands in a workspace, without what archgen knows of it."""
    return {
        path: data.decode()
        for name, data in contents(folder).items()
        if data is not None and not (path := str(name)).startswith(".archgen")
    }


def test_files_of_others_stay_and_own_ones_follow(tmp_path: Path) -> None:
    (tmp_path / "mine.txt").write_text("mine")
    assert verbs(generate(tmp_path, files(a="1", b__c="2"))) == {"a": "new", "b/c": "new"}
    assert verbs(generate(tmp_path, files(a="1!", d="3"))) == {"a": "changed", "b/c": "removed", "d": "new"}
    assert texts(tmp_path) == {"mine.txt": "mine", "a": "1!", "d": "3"}
    assert not (tmp_path / "b").exists()
    assert verbs(generate(tmp_path, [])) == {"a": "removed", "d": "removed"}
    assert texts(tmp_path) == {"mine.txt": "mine"}
    assert not (tmp_path / ".archgen").exists()


def test_what_is_the_same_is_not_touched(tmp_path: Path) -> None:
    generate(tmp_path, files(a="1", b="2"))
    stamps = {path: path.stat().st_mtime_ns for path in (tmp_path / "a", tmp_path / ".archgen" / "code.json")}
    for path in stamps:
        os.utime(path, ns=(1, 1))
    assert verbs(generate(tmp_path, files(b="2", a="1"))) == {"a": "same", "b": "same"}
    assert {path: path.stat().st_mtime_ns for path in stamps} == dict.fromkeys(stamps, 1)


def test_an_edited_file_is_left_until_its_owner_decides(tmp_path: Path) -> None:
    generate(tmp_path, files(a="1", b="1", c="1"))
    for name in "abc":
        (tmp_path / name).write_text("by hand")
    for _ in range(2):
        assert verbs(generate(tmp_path, files(a="2", b="2", c="2"))) == dict.fromkeys("abc", "edited")
        assert set(texts(tmp_path).values()) == {"by hand"}
    choices = UserChoices(overwritten=("a",), kept=("b",))
    assert verbs(generate(tmp_path, files(a="2", b="2"), choices=choices)) == {
        "a": "changed",
        "b": "yours",
        "c": "left",
    }
    assert texts(tmp_path) == {"a": "2", "b": "by hand", "c": "by hand"}
    assert verbs(generate(tmp_path, files(a="3", b="3"))) == {"a": "changed", "b": "yours"}
    assert verbs(generate(tmp_path, files(b="3"), choices=UserChoices(overwritten=("b",)))) == {
        "a": "removed",
        "b": "changed",
    }
    assert texts(tmp_path) == {"b": "3", "c": "by hand"}


def test_an_edited_file_that_becomes_what_is_made_is_archgens_again(tmp_path: Path) -> None:
    generate(tmp_path, files(a="1"))
    (tmp_path / "a").write_text("2")
    assert verbs(generate(tmp_path, files(a="2"))) == {"a": "same"}
    assert verbs(generate(tmp_path, files(a="3"))) == {"a": "changed"}


def test_a_file_of_the_users_is_never_replaced(tmp_path: Path) -> None:
    (tmp_path / "a").write_text("mine")
    assert verbs(generate(tmp_path, files(a="1", b="1"))) == {"a": "foreign", "b": "new"}
    assert verbs(generate(tmp_path, files(a="1"), choices=UserChoices(overwritten=("a",)))) == {
        "a": "foreign",
        "b": "removed",
    }
    assert verbs(generate(tmp_path, files(a="1"), choices=UserChoices(kept=("a",)))) == {"a": "yours"}
    assert verbs(generate(tmp_path, [])) == {"a": "yours"}
    assert texts(tmp_path) == {"a": "mine"}


def test_a_file_made_once_is_the_users(tmp_path: Path) -> None:
    def once(text: str, *words: str) -> list[GeneratedFile]:
        return [GeneratedFile("own.py", text.encode(), once=True, expected_words=words)]

    assert verbs(generate(tmp_path, once("empty"))) == {"own.py": "new"}
    (tmp_path / "own.py").write_text("def on_scan(): ...")
    plan = generate(tmp_path, once("another", "on_scan", "on_image", "scan"))
    assert [step.verb for step in plan.steps] == ["yours"]
    assert [each.message for step in plan.steps for each in step.findings] == ["it lacks `on_image`", "it lacks `scan`"]
    assert plan.has_unfit_code
    assert texts(tmp_path) == {"own.py": "def on_scan(): ..."}
    assert verbs(generate(tmp_path, [])) == {"own.py": "yours"}
    assert verbs(generate(tmp_path, [])) == {}
    assert texts(tmp_path) == {"own.py": "def on_scan(): ..."}
    (tmp_path / "own.py").unlink()
    assert verbs(generate(tmp_path, once("another"))) == {"own.py": "new"}


def test_what_nobody_wrote_into_goes_with_its_element(tmp_path: Path) -> None:
    generate(tmp_path, [GeneratedFile("own.py", b"def on_scan(): ...", once=True, expected_words=("on_scan",))])
    other = GeneratedFile("own.py", b"def on_image(): ...", once=True, expected_words=("on_image",))
    (step,) = generate(tmp_path, [other]).steps
    assert [each.message for each in step.findings] == [
        "is of an older model, and nobody wrote into it: take it away for a new one (it lacks `on_image`)"
    ]
    assert verbs(generate(tmp_path, [])) == {"own.py": "removed"}


def test_programs_may_be_run(tmp_path: Path) -> None:
    def mode() -> int:
        return (tmp_path / "run").stat().st_mode & 0o777

    made = GeneratedFile("run", b"1", executable=True)
    old_mask = os.umask(0o027)
    try:
        generate(tmp_path, [made])
        assert mode() == 0o750
        (tmp_path / "run").chmod(0o644)
        assert verbs(generate(tmp_path, [made])) == {"run": "changed"}
        assert mode() == 0o755
        generate(tmp_path, [GeneratedFile("run", b"2", executable=True)])
        assert mode() == 0o755
        generate(tmp_path, [GeneratedFile("run", b"2")])
        assert mode() == 0o644
    finally:
        os.umask(old_mask)


def test_partners_generate_their_parts_in_one_folder(tmp_path: Path) -> None:
    generate(tmp_path, files(common="1", a="1"), "robot --select owner:a")
    generate(tmp_path, files(common="1", b="1"), "robot --select owner:b")
    assert verbs(generate(tmp_path, files(common="2"), "robot --select owner:a")) == {
        "a": "removed",
        "common": "changed",
    }
    assert texts(tmp_path) == {"common": "2", "b": "1"}
    generate(tmp_path, [], "robot --select owner:a")
    assert texts(tmp_path) == {"common": "2", "b": "1"}
    generate(tmp_path, [], "robot --select owner:b")
    assert texts(tmp_path) == {}


def test_a_run_for_everything_stands_for_all_of_its_parts(tmp_path: Path) -> None:
    generate(tmp_path, files(a="1", b="1"), "robot --host arm_pc")
    generate(tmp_path, files(c="1"), "robot_2 --host arm_pc")
    generate(tmp_path, files(a="1", b="1", d="1"), "robot")
    # The host is gone: nobody can generate for it any more.
    assert verbs(generate(tmp_path, files(a="1"), "robot")) == {"a": "same", "b": "removed", "d": "removed"}
    assert verbs(generate(tmp_path, [], "robot --host arm_pc")) == {}
    assert texts(tmp_path) == {"a": "1", "c": "1"}


def test_two_backends_know_of_each_other(tmp_path: Path) -> None:
    generate(tmp_path, files(a="1"), backend="code")
    generate(tmp_path, files(b="1"), backend="other")
    assert read_other_records(tmp_path, "code") == {"b": "other"}
    assert verbs(generate(tmp_path, [], backend="other")) == {"b": "removed"}
    assert texts(tmp_path) == {"a": "1"}


@pytest.mark.parametrize("change", [("a", "a/b"), ("a/b", "a"), ("A", "a"), ("x/A", "X/a")])
def test_a_file_takes_the_place_of_a_folder_and_of_another_case(tmp_path: Path, change: tuple[str, str]) -> None:
    old, new = change
    generate(tmp_path, [GeneratedFile(old, b"1")])
    assert verbs(generate(tmp_path, [GeneratedFile(new, b"2")])) == {old: "removed", new: "new"}
    assert texts(tmp_path) == {new: "2"}


def test_links_are_not_followed(tmp_path: Path) -> None:
    outside, folder = tmp_path / "outside", tmp_path / "ws"
    outside.mkdir()
    (outside / "f").write_text("outside")
    folder.mkdir()
    (folder / "d").symlink_to(outside)
    (folder / "f").symlink_to(outside / "f")
    (folder / "g").mkdir()
    (folder / "g" / "mine").touch()
    plan = generate(folder, files(d__f="1", f="1", g="1", h="1"))
    assert [(step.path, step.verb, step.note) for step in plan.steps] == [
        ("d/f", "blocked", "`d` is a link"),
        ("f", "blocked", "`f` is a link"),
        ("g", "blocked", "`g` is a folder"),
        ("h", "new", ""),
    ]
    assert contents(outside) == {"f": b"outside"}
    # One that was a folder of archgen's before.
    generate(folder, files(h="1", k__f="outside", k__deep__f="1"))
    shutil.rmtree(folder / "k")
    (folder / "k").symlink_to(outside)
    (outside / "deep").mkdir()
    assert verbs(generate(folder, files(h="1"))) == {"h": "same"}
    assert contents(outside) == {"f": b"outside"}
    assert (outside / "deep").is_dir()


def test_a_record_that_is_a_link_is_refused(tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "ws").mkdir()
    (tmp_path / "ws" / ".archgen").symlink_to(tmp_path / "elsewhere")
    with pytest.raises(OutputError, match="is a link"):
        generate(tmp_path / "ws", files(a="1"))
    assert list((tmp_path / "elsewhere").iterdir()) == []


@pytest.mark.parametrize(
    "text",
    [
        "",
        "{",
        "[]",
        '{"archgen": 2, "files": {}}',
        '{"archgen": 1, "files": {"../x": {"sha256": "0", "runs": []}}}',
        '{"archgen": 1, "files": {".git/hooks/x": {"sha256": "0", "runs": []}}}',
        '{"archgen": 1, "files": {"/x": {"sha256": "0", "runs": []}}}',
        '{"archgen": 1, "files": {"x": {"sha256": 3, "runs": []}}}',
        '{"archgen": 1, "files": {"x": []}}',
        "<<<<<<< ours",
        "[" * 100_000,
    ],
)
def test_a_damaged_record_is_refused(tmp_path: Path, text: str) -> None:
    (tmp_path / ".archgen").mkdir()
    (tmp_path / ".archgen" / "code.json").write_text(text)
    with pytest.raises(OutputError, match="does not say what archgen wrote"):
        generate(tmp_path, files(a="1"))
    assert texts(tmp_path) == {}


def test_a_record_of_a_newer_archgen_is_no_damage(tmp_path: Path) -> None:
    (tmp_path / ".archgen").mkdir()
    (tmp_path / ".archgen" / "code.json").write_text('{"archgen": 2, "files": {"x": {"digest": "0"}}}')
    with pytest.raises(OutputError, match="another version of archgen wrote it"):
        generate(tmp_path, files(a="1"))


def test_a_record_says_what_it_read(tmp_path: Path) -> None:
    made = [*files(a="1", b__ä="2"), GeneratedFile("c", b"3", executable=True), GeneratedFile("d", b"4", once=True)]
    (tmp_path / "e").write_text("own")
    generate(tmp_path, [*made, *files(e="5")], choices=UserChoices(kept=("e",)))
    record = read_run_record(tmp_path, "code")
    assert set(record.files) == {"a", "b/ä", "c", "d", "e"}
    assert write_run_record(record) == (tmp_path / ".archgen" / "code.json").read_bytes()


def test_another_archgen_waits(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(file_tree, "_LOCK_TRIES", 2)
    with workspace_writing.lock_workspace(tmp_path), pytest.raises(OutputError, match="another archgen"):
        generate(tmp_path, files(a="1"))


class _Killed(BaseException):
    """The process ends here."""


def _count_steps(monkeypatch: pytest.MonkeyPatch, last_step: int) -> Callable[[], int]:
    """Let the process die in front of the given step: each change of the disk is one. Return how many there were."""
    done = [0]

    def watch(owner: object, name: str) -> None:
        real = getattr(owner, name)

        def step(*words: object, **named: object) -> object:
            if done[0] == last_step:
                raise _Killed
            done[0] += 1
            return real(*words, **named)

        monkeypatch.setattr(owner, name, step)

    for name in ("mkdir", "write_bytes", "unlink", "rmdir", "chmod"):
        watch(Path, name)
    watch(os, "replace")
    # A killed process cleans nothing up.
    monkeypatch.setattr(shutil, "rmtree", lambda *_words, **_named: None)
    return lambda: done[0]


OLD = [
    *files(same="=", changed="old", gone__deep__x="old", swap="old", made__x="x"),
    GeneratedFile("run", b"#!", executable=True),
]
NEW = [
    *files(same="=", changed="new", swap__inner="new", made="now a file", fresh__y="new"),
    GeneratedFile("run", b"#!"),
    GeneratedFile("go", b"#!", executable=True),
    GeneratedFile("own", b"1", once=True),
]


def _list_steps(tmp_path: Path) -> Iterator[int]:
    """Yield the steps of writing NEW over OLD, one for each that can be the last."""
    folder = tmp_path / "counted"
    generate(folder, OLD)
    with pytest.MonkeyPatch.context() as patch:
        count = _count_steps(patch, -1)
        generate(folder, NEW)
    yield from range(count())


def test_a_run_that_is_killed_at_any_step_is_healed_by_the_next(tmp_path: Path) -> None:
    steps = list(_list_steps(tmp_path))
    assert len(steps) > 15
    clean = tmp_path / "clean"
    generate(clean, NEW)
    old_texts, new_texts = ({each.path: each.data.decode() for each in made} for made in (OLD, NEW))
    for step in steps:
        folder = tmp_path / f"killed{step}"
        generate(folder, OLD)
        (folder / "mine").write_text("mine")
        with pytest.MonkeyPatch.context() as patch:
            _count_steps(patch, step)
            with pytest.raises(_Killed):
                generate(folder, NEW)
        for path, text in texts(folder).items():
            assert text in {old_texts.get(path), new_texts.get(path), "mine"}, (step, path)
        # What is known is true: no file that archgen wrote is taken for one that somebody edited.
        again = generate(folder, NEW)
        assert not again.conflicts, step
        assert "left" not in verbs(again).values(), step
        (folder / "mine").unlink()
        assert contents(folder) == contents(clean), step
        # And back: what the killed run began is known to one that does not want it.
        assert set(verbs(generate(folder, [])).values()) <= {"removed", "yours"}


def test_what_a_killed_run_began_can_be_dropped_at_once(tmp_path: Path) -> None:
    for step in _list_steps(tmp_path):
        folder = tmp_path / f"killed{step}"
        generate(folder, OLD)
        with pytest.MonkeyPatch.context() as patch:
            _count_steps(patch, step)
            with pytest.raises(_Killed):
                generate(folder, NEW)
        generate(folder, [])
        # The user's own file stays; nothing else does, not even a folder.
        assert {path.name for path in folder.rglob("*")} <= {"own"}, step


def test_a_full_disk_changes_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    generate(tmp_path, OLD)
    before = contents(tmp_path)
    real_write = Path.write_bytes

    def write(path: Path, data: bytes) -> int:
        if data == b"new":
            raise OSError(28, "No space left on device")
        return real_write(path, data)

    monkeypatch.setattr(Path, "write_bytes", write)
    with pytest.raises(OSError, match="No space"):
        generate(tmp_path, NEW)
    assert contents(tmp_path) == before


def test_a_closed_folder_is_said_before_anything_is_changed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    generate(tmp_path, files(a="1", closed__b="1"))
    before = contents(tmp_path)
    monkeypatch.setattr(os, "access", lambda path, _mode: Path(path).name != "closed")
    with pytest.raises(OutputError, match="closed may not be written"):
        generate(tmp_path, files(a="2", closed__b="2"))
    assert contents(tmp_path) == before


@pytest.mark.parametrize(
    ("paths", "problem"),
    [
        (["a/b.py", "c.py"], None),
        (
            ["Node.py", "node.py"],
            "`Node.py` (x.yaml:1:1) and `node.py` (x.yaml:2:1) fall together: on many systems they are one file",
        ),
        (["a", "a"], "`a` (x.yaml:1:1) and `a` (x.yaml:2:1) fall together: two files of one name"),
        (
            ["a", "A/b"],
            "`a` (x.yaml:1:1) and `A/b` (x.yaml:2:1) fall together: one is a file where the other needs a folder",
        ),
        (
            ["A/b", "a"],
            "`A/b` (x.yaml:1:1) and `a` (x.yaml:2:1) fall together: one is a file where the other needs a folder",
        ),
        (["\u00e9", "e\u0301"], "fall together"),
        (["../a"], "`../a` (x.yaml:1:1) is no path that every system takes"),
        (["/a"], "is no path"),
        (["a//b"], "is no path"),
        (["a/./b"], "is no path"),
        (["con.py"], "is no path"),
        (["a/NUL"], "is no path"),
        (["a:b"], "is no path"),
        (["a\\b"], "is no path"),
        (["a "], "is no path"),
        (["a."], "is no path"),
        (["a\nb"], "is no path"),
        ([".git/hooks/pre-commit"], "leads into a folder of another tool"),
        (["x/.GIT/config"], "leads into a folder of another tool"),
        (["GIT~1/config"], "leads into a folder of another tool"),
        ([".archgen/code.json"], "leads into a folder of another tool"),
        (["a" * 300], "has a part of more than 200 bytes"),
        (["a/" * 60 + "b"], "is too long a path"),
    ],
)
def test_paths_that_are_refused(paths: list[str], problem: str | None) -> None:
    made = [GeneratedFile(path, b"", place=f"x.yaml:{number}:1") for number, path in enumerate(paths, start=1)]
    found = list(find_path_problems(made))
    assert len(found) == (problem is not None)
    assert problem is None or problem in found[0]


def test_a_file_that_nobody_edited_is_taken_over_and_given_back(tmp_path: Path) -> None:
    generate(tmp_path, files(a="1", b="1", c="1"))
    kept = UserChoices(kept=("a", "c"))
    assert verbs(generate(tmp_path, files(a="2", b="2"), choices=kept)) == {"a": "yours", "b": "changed", "c": "left"}
    assert [(tmp_path / name).read_text() for name in "abc"] == ["1", "2", "1"]
    assert verbs(generate(tmp_path, files(a="3", b="3"))) == {"a": "yours", "b": "changed"}
    assert (tmp_path / "a").read_text() == "1"
    assert verbs(generate(tmp_path, files(a="3"), choices=UserChoices(overwritten=("a",)))) == {
        "a": "changed",
        "b": "removed",
    }
    assert verbs(generate(tmp_path, files(a="4"))) == {"a": "changed"}
    assert (tmp_path / "c").read_text() == "1"


def merge_by_git(folder: Path, base: str, ours: str, theirs: str, marks: str = "") -> None:
    """Merge what two branches made of a file `a` and of the record, with git's marks where it is not told how."""
    git = partial(run_git, folder)
    git("init", "-q", "-b", "main")
    for branch, text in (("main", base), ("ours", ours), ("theirs", theirs)):
        git("checkout", "-q", *(("-b", branch, "main") if branch != "main" else ("--orphan", "main")))
        generate(folder, files(a=text))
        git("add", "-A")
        git("commit", "-qm", branch)
    if marks:
        (folder / ".gitattributes").unlink()
        (folder / ".archgen" / ".gitattributes").unlink()
        git("commit", "-qam", "no attributes")
    merged = git("merge", "-q", "ours", check=False)
    assert (merged.returncode == 0) == (not marks), merged.stdout


def run_git(folder: Path, *words: str, check: bool = True) -> subprocess.CompletedProcess[str]:
    command = ("git", "-c", "user.name=a", "-c", "user.email=a@b", "-c", "commit.gpgsign=false", *words)
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=check)  # noqa: S603


@pytest.mark.parametrize("marks", ["", "marks"])
def test_what_git_made_of_two_branches_is_made_anew(tmp_path: Path, marks: str) -> None:
    merge_by_git(tmp_path, "1\n2\n3\n", "1\nx\n3\n", "1\ny\n3\n", marks)
    assert ("<<<<<<<" in (tmp_path / "a").read_text()) == bool(marks)
    assert verbs(generate(tmp_path, files(a="1\nx y\n3\n"))) == {"a": "merged"}
    assert (tmp_path / "a").read_text() == "1\nx y\n3\n"
    assert verbs(generate(tmp_path, files(a="1\nx y\n3\n"))) == {"a": "same"}


@pytest.mark.parametrize("written", ["1\nx\ny\nmine\n3\n", "<<<<<<< a\nmine\n=======\ny\n>>>>>>> b\n"])
def test_what_somebody_wrote_into_a_merge_stays(tmp_path: Path, written: str) -> None:
    merge_by_git(tmp_path, "1\n2\n3\n", "1\nx\n3\n", "1\ny\n3\n")
    (tmp_path / "a").write_text(written)
    assert verbs(generate(tmp_path, files(a="1\nx y\n3\n"))) == {"a": "edited"}
    assert (tmp_path / "a").read_text() == written


def test_lines_that_somebody_took_away_are_no_merge(tmp_path: Path) -> None:
    generate(tmp_path, files(a="1\n2\n3\n"))
    (tmp_path / "a").write_text("1\n3\n")
    assert verbs(generate(tmp_path, files(a="1\n2\n3\n4\n"))) == {"a": "edited"}


@pytest.mark.parametrize(
    ("text", "verb"),
    [
        ("1\nby us\n3\n", "merged"),
        ("<<<<<<< HEAD\nby us\n=======\n2 new\n>>>>>>> theirs\n", "merged"),
        ("1\n3\n", "edited"),
        ("1\nby us\nby hand\n", "edited"),
    ],
)
def test_one_branch_renamed_what_the_other_changed(tmp_path: Path, text: str, verb: str) -> None:
    """Git follows a file to its new name, and archgen knows the lines that it wrote under the old one."""
    generate(tmp_path, files(old="1\nby us\n3\n", new="1\n2 new\n3\n"))
    (tmp_path / "old").unlink()
    (tmp_path / "new").write_text(text)
    assert verbs(generate(tmp_path, files(new="1\n2 new\nby us too\n3\n")))["new"] == verb


def test_git_takes_files_that_are_no_text_as_they_are(tmp_path: Path) -> None:
    """An asset of a backend may be a picture: `eol` alone says that it is a text, of which git changes the ends of lines."""
    run_git(tmp_path, "init", "-q")
    data = b"\x89PNG\r\n\x1a\n\0\0\r\n"
    generate(tmp_path, [GeneratedFile("logo.png", data), GeneratedFile("a", b"text\n")])
    run_git(tmp_path, "add", "-A")
    (tmp_path / "logo.png").unlink()
    run_git(tmp_path, "checkout", "--", "logo.png")
    assert (tmp_path / "logo.png").read_bytes() == data


def test_attributes_of_the_user_stay(tmp_path: Path) -> None:
    run_git(tmp_path, "init", "-q")
    (tmp_path / ".gitattributes").write_text("*.png binary\n")
    generate(tmp_path, files(a="1"))
    text = (tmp_path / ".gitattributes").read_text()
    assert text.startswith("*.png binary\n# archgen: ")
    assert "\n/a merge=union text=auto eol=lf linguist-generated\n" in text
    assert (tmp_path / ".archgen" / ".gitattributes").exists()
    (tmp_path / ".gitattributes").write_text(f"{text}*.jpg binary")
    generate(tmp_path, files(b="1"))
    assert (tmp_path / ".gitattributes").read_text() == f"{text.replace('/a ', '/b ')}*.jpg binary"
    (tmp_path / ".gitattributes").write_text(text)
    generate(tmp_path, [])
    assert not (tmp_path / ".archgen").exists()
    assert (tmp_path / ".gitattributes").read_text() == "*.png binary\n"


def test_a_second_run_asks_once_for_each_file_and_writes_no_record(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = files(a__b="1", a__c="2", d="3")
    generate(tmp_path, made)
    asked: list[str] = []

    def note(function: Callable[..., object], path: object, *arguments: object, **options: object) -> object:
        asked.append(os.path.relpath(os.fspath(path), tmp_path) if isinstance(path, str) else "")
        return function(path, *arguments, **options)

    for name in ("lstat", "stat", "open"):
        monkeypatch.setattr(os, name, partial(note, getattr(os, name)))
    monkeypatch.delattr(workspace_writing, "write_run_record")
    assert verbs(generate(tmp_path, made)) == {"a/b": "same", "a/c": "same", "d": "same"}
    assert [asked.count(path) for path in ("a/b", "a/c", "d")] == [1, 1, 1]


def test_a_record_that_somebody_laid_out_anew_is_written_again(tmp_path: Path) -> None:
    generate(tmp_path, files(a="1"))
    record = tmp_path / ".archgen" / "code.json"
    before = record.read_bytes()
    record.write_text(json.dumps(json.loads(before), indent=4))
    generate(tmp_path, files(a="1"))
    assert record.read_bytes() == before
