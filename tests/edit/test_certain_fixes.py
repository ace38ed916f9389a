"""What `archgen check --fix` writes: what can mean only one thing, and nothing where the project would say something else."""

from __future__ import annotations

import codecs
from pathlib import Path

import pytest

from archgen.edit.certain_fixes import plan_certain_fixes
from archgen.pipeline import check_project
from tests.planted_slips import SEED, is_same_model, judge_text

SLIPS = {
    "owner: wur": "owner: WUR",
    'reviewers: "@wur/agro"': "reviewers: @wur/agro",
    "status: existing": "Status: existing",
    "wcet: 20 ms": "wcet: 20 MS",
    "host: onboard_pc": "host: onboard-pc",
    "trigger: [persons]": "trigger: persons",
}


def write(folder: Path, text: str, slice_text: str = "") -> Path:
    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    if slice_text:
        (folder / "b.yaml").write_text(slice_text, encoding="utf-8")
    return folder


def fix_all(folder: Path) -> list[int]:
    """Write fixes until there are none; return how many each round made."""
    counts: list[int] = []
    while planned := list(plan_certain_fixes(check_project(folder))):
        for edit, count in planned:
            (folder / edit.file).write_bytes(edit.new_content)
            counts.append(count)
    return counts


def test_slips_of_form_are_mended_to_the_model_that_was_meant(tmp_path: Path) -> None:
    text = SEED
    for sound, slip in SLIPS.items():
        text = text.replace(sound, slip, 1)
    assert sum(fix_all(write(tmp_path, text))) == len(SLIPS)
    fixed = (tmp_path / "archgen.yaml").read_text(encoding="utf-8")
    assert is_same_model(judge_text(fixed).architecture, judge_text(SEED).architecture)


@pytest.mark.parametrize(
    ("sound", "slip"),
    [
        ("role: source", "rol: source"),  # a guess
        ("size: 2 MB", "size: 2 Mb"),  # bits or bytes
        ("wcet: 20 ms", "wcet: 20"),
        ("from: perception.stereo_camera.depth", "from: perception.stereo_camera.dept"),
        ("rate: 15 Hz", "rate: 66 ms"),
    ],
)
def test_guesses_are_left_to_people(tmp_path: Path, sound: str, slip: str) -> None:
    assert fix_all(write(tmp_path, SEED.replace(sound, slip, 1))) == []


def test_a_mark_and_line_ends_stay_and_libraries_are_not_touched(tmp_path: Path) -> None:
    text = "archgen: 1\r\nlibraries: {lib: lib}\r\npartners: {wur: Wageningen}\r\ngroups: {g: {owner: WUR}}\r\n"
    (tmp_path / "archgen.yaml").write_bytes(codecs.BOM_UTF8 + text.encode())
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib/a.yaml").write_text("component_types: {laser: {Title: x, outputs: {scan: Scan}}}\n")
    assert fix_all(tmp_path) == [1]
    assert (tmp_path / "archgen.yaml").read_bytes() == codecs.BOM_UTF8 + text.replace("WUR", "wur").encode()
    assert "Title" in (tmp_path / "lib/a.yaml").read_text()


def test_what_is_not_asked_for_stays(tmp_path: Path) -> None:
    write(tmp_path, "archgen: 1\npartners: {wur: W}\ngroups: {g: {Title: x}}\n", "groups: {h: {Title: y}}\n")
    assert [edit.file for edit, _ in plan_certain_fixes(check_project(tmp_path), {"b.yaml"})] == ["b.yaml"]


def test_a_fix_that_would_make_a_key_twice_is_left_out(tmp_path: Path) -> None:
    write(tmp_path, "archgen: 1\npartners: {wur: W}\ngroups: {g: {owner: WUR, title: a, Title: b}}\n")
    assert fix_all(tmp_path) == [1]
    assert "{owner: wur, title: a, Title: b}" in (tmp_path / "archgen.yaml").read_text(encoding="utf-8")
