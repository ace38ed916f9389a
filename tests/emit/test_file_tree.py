"""Outputs get onto the disk whole, and nothing that archgen did not write is touched."""

from __future__ import annotations

import fcntl
import os
import threading
from pathlib import Path

import pytest

from archgen.emit import file_tree
from archgen.emit.file_tree import TREE_MANIFEST, FileTree, OutputError, make_file_tree, write_file, write_tree
from archgen.emit.safe_names import assign_safe_paths, is_safe_path, make_safe_path, make_slug


def site(**files: str) -> FileTree:
    return make_file_tree((name.replace("__", "/").replace("_", "."), text.encode()) for name, text in files.items())


def on_disk(folder: Path) -> dict[str, str]:
    return {p.relative_to(folder).as_posix(): p.read_text() for p in sorted(folder.rglob("*")) if p.is_file()}


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("Point cloud", "point-cloud"),
        ("R-12", "r-12"),
        ("../../etc/passwd", "etc-passwd"),
        ("/abs", "abs"),
        ("con", "con_"),
        ("NUL.html", "nul_.html"),
        ("com1.tar.gz", "com1_.tar.gz"),
        ("console.html", "console.html"),
        ("Überwachung\x00\n", "uberwachung"),
        ("<script>", "script"),
        ("a.", "a"),
    ],
)
def test_any_text_becomes_one_safe_name(text: str, name: str) -> None:
    assert make_slug(text) == name
    assert is_safe_path(name)


def test_long_names_keep_their_ending_and_differ() -> None:
    one, two = make_slug("a" * 300 + "b.html"), make_slug("a" * 300 + "c.html")
    assert one != two
    assert len(one) == len(two) == 100
    assert one.endswith(".html")


def test_text_without_a_latin_letter_is_told_apart() -> None:
    assert make_slug("抓取") != make_slug("移动")
    assert is_safe_path(make_slug(".."))
    assert is_safe_path(make_slug(""))


def test_paths_stay_below_the_folder() -> None:
    assert make_safe_path("../a/./b//../C.html") == "a/b/c.html"
    assert make_safe_path("C:\\x\\y") == "c/x/y"
    assert is_safe_path(make_safe_path("../.."))


def test_collisions_are_resolved_in_order() -> None:
    wanted = ["types/Point cloud.html", "types/point cloud.html", "types/point-cloud.html", "a", "a/b", "A/c"]
    assert list(assign_safe_paths(wanted).values()) == [
        "types/point-cloud.html",
        "types/point-cloud-2.html",
        "types/point-cloud-3.html",
        "a",
        "a-2/b",
        "a-2/c",
    ]


def test_a_file_gives_way_to_a_folder() -> None:
    assert assign_safe_paths(["a/b", "a"]) == {"a/b": "a/b", "a": "a-2"}


@pytest.mark.parametrize("path", ["../a", "/a", "a//b", "a/..", "con", "a:b", "x\n", "", "a/.", "b.", TREE_MANIFEST])
def test_a_tree_takes_no_unsafe_path(path: str) -> None:
    with pytest.raises(ValueError, match="no safe name"):
        make_file_tree([(path, b"")])


def test_a_tree_takes_no_two_names_that_differ_in_case_only() -> None:
    with pytest.raises(ValueError, match="two output files"):
        make_file_tree([("a.html", b""), ("A.html", b"")])


def test_write_makes_the_folder_and_says_what_it_did(tmp_path: Path) -> None:
    out = tmp_path / "deep" / "out"
    assert write_tree(site(a_html="1", b__c_html="2"), out).written == ("a.html", "b/c.html")
    assert {k: v for k, v in on_disk(out).items() if k != TREE_MANIFEST} == {"a.html": "1", "b/c.html": "2"}
    assert [p.name for p in out.parent.iterdir()] == ["out"]  # nothing left beside it


def test_write_again_touches_nothing(tmp_path: Path) -> None:
    write_tree(site(a_html="1"), tmp_path / "out")
    os.utime(tmp_path / "out/a.html", (1, 1))
    os.utime(tmp_path / "out" / TREE_MANIFEST, (1, 1))
    again = write_tree(site(a_html="1"), tmp_path / "out")
    assert (again.written, again.unchanged, again.removed) == ((), ("a.html",), ())
    assert (tmp_path / "out/a.html").stat().st_mtime == 1
    assert (tmp_path / "out" / TREE_MANIFEST).stat().st_mtime == 1


def test_stale_files_of_our_own_go_with_their_folders(tmp_path: Path) -> None:
    write_tree(site(a_html="1", b__c__d_html="2"), tmp_path / "out")
    assert write_tree(site(a_html="3"), tmp_path / "out").removed == ("b/c/d.html",)
    assert sorted(on_disk(tmp_path / "out")) == [TREE_MANIFEST, "a.html"]
    assert not (tmp_path / "out/b").exists()


def test_a_file_may_become_a_folder(tmp_path: Path) -> None:
    write_tree(site(a="1"), tmp_path / "out")
    write_tree(site(a__b="2"), tmp_path / "out")
    assert (tmp_path / "out/a/b").read_text() == "2"
    write_tree(site(a="3"), tmp_path / "out")
    assert (tmp_path / "out/a").read_text() == "3"


def test_a_folder_with_files_of_others_is_left_alone(tmp_path: Path) -> None:
    out = tmp_path / "out"
    out.mkdir()
    (out / "thesis.txt").write_text("ten years")
    with pytest.raises(OutputError) as caught:
        write_tree(site(a_html="1"), out)
    assert caught.value.message == f"{out} holds files that archgen did not write: `thesis.txt`"
    assert caught.value.help
    assert on_disk(out) == {"thesis.txt": "ten years"}


def test_a_foreign_file_among_our_own_stops_too(tmp_path: Path) -> None:
    write_tree(site(a_html="1", b_html="1"), tmp_path / "out")
    (tmp_path / "out/sub").mkdir()
    (tmp_path / "out/sub/mine.txt").write_text("x")
    with pytest.raises(OutputError, match=r"did not write: `sub/mine.txt`"):
        write_tree(site(a_html="2"), tmp_path / "out")
    assert (tmp_path / "out/a.html").read_text() == "1"
    assert (tmp_path / "out/b.html").exists()


def test_a_file_that_somebody_changed_is_theirs(tmp_path: Path) -> None:
    write_tree(site(a_html="1"), tmp_path / "out")
    (tmp_path / "out/a.html").write_text("edited by hand")
    with pytest.raises(OutputError, match=r"changed after archgen wrote them: `a.html`"):
        write_tree(site(a_html="2"), tmp_path / "out")
    assert (tmp_path / "out/a.html").read_text() == "edited by hand"


def test_what_file_managers_leave_is_no_obstacle(tmp_path: Path) -> None:
    write_tree(site(a_html="1"), tmp_path / "out")
    (tmp_path / "out/.DS_Store").write_text("")
    assert write_tree(site(a_html="2"), tmp_path / "out").written == ("a.html",)


def test_a_link_in_the_folder_is_not_followed(tmp_path: Path) -> None:
    outside = tmp_path / "outside"
    outside.mkdir()
    write_tree(site(b__c="1"), tmp_path / "out")
    (tmp_path / "out/b/c").unlink()
    (tmp_path / "out/b").rmdir()
    (tmp_path / "out/b").symlink_to(outside)
    with pytest.raises(OutputError, match=r"did not write: `b`"):
        write_tree(site(b__c="2"), tmp_path / "out")
    assert list(outside.iterdir()) == []


def test_a_manifest_that_lies_removes_nothing_outside(tmp_path: Path) -> None:
    (tmp_path / "victim").write_text("")
    out = tmp_path / "out"
    out.mkdir()
    empty = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"
    (out / TREE_MANIFEST).write_text(f"{empty}  ../victim\n{empty}  /etc/hostname\nnonsense\n")
    assert write_tree(site(a="1"), out).removed == ()
    assert (tmp_path / "victim").exists()


def test_a_run_that_was_cut_off_is_no_obstacle(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_tree(site(a="1", b="1", c="1"), tmp_path / "out")
    real, calls = os.replace, []

    def breaks_off(source: Path, target: Path) -> None:
        calls.append(target)
        if len(calls) == 3:
            raise OSError(28, "No space left on device")
        real(source, target)

    monkeypatch.setattr(os, "replace", breaks_off)
    with pytest.raises(OutputError, match="No space left on device"):
        write_tree(site(a="2", b="2"), tmp_path / "out")
    monkeypatch.undo()
    assert {(tmp_path / "out" / name).read_text() for name in "ab"} == {"1", "2"}
    write_tree(site(a="2", b="2"), tmp_path / "out")
    assert {k: v for k, v in on_disk(tmp_path / "out").items() if k != TREE_MANIFEST} == {"a": "2", "b": "2"}
    assert [p.name for p in tmp_path.iterdir()] == ["out"]


def test_the_folder_may_not_be_a_file(tmp_path: Path) -> None:
    (tmp_path / "out").write_text("x")
    with pytest.raises(OutputError, match="is a file, not a folder"):
        write_tree(site(a="1"), tmp_path / "out")
    with pytest.raises(OutputError, match="cannot write"):
        write_tree(site(a="1"), tmp_path / "out" / "below")


def test_one_file_is_replaced_whole(tmp_path: Path) -> None:
    (tmp_path / "target").write_text("precious")
    (tmp_path / "report.docx").symlink_to(tmp_path / "target")
    write_file(tmp_path / "report.docx", b"new")
    assert (tmp_path / "target").read_text() == "precious"
    assert (tmp_path / "report.docx").read_text() == "new"
    assert not (tmp_path / "report.docx").is_symlink()
    assert sorted(p.name for p in tmp_path.iterdir()) == ["report.docx", "target"]


def test_one_file_gets_ordinary_permissions(tmp_path: Path) -> None:
    (tmp_path / "plain").write_text("")
    write_file(tmp_path / "sub" / "packed.yaml", b"x")
    assert (tmp_path / "sub/packed.yaml").stat().st_mode == (tmp_path / "plain").stat().st_mode


@pytest.mark.parametrize("place", ["folder", "fifo"])
def test_one_file_is_never_written_over_something_else(tmp_path: Path, place: str) -> None:
    (tmp_path / "folder").mkdir()
    os.mkfifo(tmp_path / "fifo")
    with pytest.raises(OutputError, match="not a regular file"):
        write_file(tmp_path / place, b"x")


def test_what_comes_after_many_bytes_waits_on_disk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    files = [(f"f{number}.txt", f"{number}\n".encode() * 9) for number in range(9, -1, -1)]
    held = make_file_tree(files)
    monkeypatch.setattr(file_tree, "_MAX_HELD_BYTES", 40)
    stored = make_file_tree(files)
    assert dict(stored.files) == dict(held.files) == dict(files)
    assert list(stored.files) == sorted(dict(files))
    assert write_tree(stored, tmp_path / "out").written == tuple(held.files)
    assert {path.name: path.read_bytes() for path in (tmp_path / "out").glob("*.txt")} == dict(files)
    assert write_tree(held, tmp_path / "out").unchanged == tuple(held.files)


def test_what_killed_runs_left_is_removed_and_what_runs_hold_is_not(tmp_path: Path) -> None:
    out = tmp_path / "out"
    for folder in (tmp_path, out):
        for name in ("killed__", "held____"):
            (folder / f".archgen-new-{name}").mkdir(parents=True)
            (folder / f".archgen-new-{name}" / "half").write_text("x")
    (tmp_path / ".archgen-new-of-somebody-else").mkdir()
    (tmp_path / ".archgen-new-a_link__").symlink_to(tmp_path / "held", target_is_directory=True)
    (tmp_path / ".archgen-new-a_file__").write_text("own")
    descriptors = [os.open(folder / ".archgen-new-held____", os.O_RDONLY) for folder in (tmp_path, out)]
    for descriptor in descriptors:
        fcntl.flock(descriptor, fcntl.LOCK_EX)
    write_file(tmp_path / "a.txt", b"a")
    write_tree(site(a="1"), out)
    for descriptor in descriptors:
        os.close(descriptor)
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        *(".archgen-new-a_file__", ".archgen-new-a_link__", ".archgen-new-held____", ".archgen-new-of-somebody-else"),
        *("a.txt", "out"),
    ]
    assert sorted(path.name for path in out.iterdir()) == [".archgen-files", ".archgen-new-held____", "a"]


def test_a_run_waits_for_another_one_in_the_same_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    out = tmp_path / "new" / "out"
    with file_tree.lock_folder(out):
        waiting = threading.Thread(target=write_tree, args=(site(a="1"), out))
        waiting.start()
        waiting.join(0.3)
        assert waiting.is_alive()
    # The first one wrote nothing, and took the folder away that the other one waited for.
    waiting.join(120)
    assert on_disk(out).keys() == {"a", TREE_MANIFEST}
    monkeypatch.setattr(file_tree, "_LOCK_TRIES", 2)
    with file_tree.lock_folder(out), pytest.raises(OutputError, match="another archgen is writing into"):
        write_tree(site(a="2"), out)


def test_a_file_system_without_locks_takes_files_all_the_same(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise OSError(37, "No locks available")

    monkeypatch.setattr("fcntl.flock", refuse)
    (tmp_path / "out" / ".archgen-new-12345678").mkdir(parents=True)
    write_tree(site(a="1"), tmp_path / "out")
    write_file(tmp_path / "b", b"b")
    # Whether somebody is at work in it cannot be told: it stays, and is no obstacle.
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == [
        ".archgen-files",
        ".archgen-new-12345678",
        "a",
    ]
    write_tree(site(a="2"), tmp_path / "out")
    assert (tmp_path / "out" / "a").read_text() == "2"


def test_a_file_keeps_its_permissions(tmp_path: Path) -> None:
    (tmp_path / "a").write_text("1")
    (tmp_path / "a").chmod(0o640)
    file_tree.replace_file(tmp_path / "a", b"2")
    assert (tmp_path / "a").stat().st_mode & 0o777 == 0o640


def test_a_folder_is_written_whose_parent_takes_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is a disk of its own, for instance, or the one folder that a container may write."""
    (tmp_path / "out").mkdir()
    real = os.mkdir

    def refuse(path: str, *others: int) -> None:
        if Path(path).parent == tmp_path:
            raise PermissionError(13, "Permission denied", path)
        real(path, *others)

    monkeypatch.setattr(os, "mkdir", refuse)
    write_tree(site(a="1"), tmp_path / "out")
    assert (tmp_path / "out" / "a").read_text() == "1"
