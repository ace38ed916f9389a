"""Files of strangers: too large, too deep, cut off, in circles; each gets a clear word in bounded time."""

from __future__ import annotations

import time
from itertools import islice
from pathlib import Path

import pytest

from archgen.importers.foreign_files import read_bounded
from archgen.importers.foreign_import import ForeignFileError
from archgen.plugins.aadl import aadl_import, hardware_mapping, system_walk
from archgen.plugins.aadl.aadl_import import read_aadl
from archgen.plugins.aadl.hardware_mapping import HardwareTree
from archgen.plugins.aadl.token_cursor import TooManyTokensError, scan_tokens
from tests.plugins.aadl.aadl_texts import MODELS, import_package, import_text, list_faults, merge_slices, tell_notes
from tests.property_sizes import try_some

PATIENCE = 60.0
"""Seconds for what takes a few on an idle machine; what grows with the square of its length takes hours."""


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"", "neither a package nor a property set"),
        (b"<?xml version='1.0'?><a/>", "neither a package nor a property set"),
        (b"\x7fELF\x00\x00", "it is no text"),
        (b"\xff\xfep", "it is no text in UTF-16"),
    ],
)
def test_what_is_no_aadl_is_refused(tmp_path: Path, data: bytes, words: str) -> None:
    (tmp_path / "m.aadl").write_bytes(data)
    with pytest.raises(ForeignFileError, match=words):
        read_aadl([tmp_path / "m.aadl"])


def test_a_large_file_is_refused_before_it_is_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(aadl_import, "read_bounded", lambda file: read_bounded(file, 2_000_000))
    (tmp_path / "m.aadl").write_bytes(b" " * 2_000_001)
    with pytest.raises(ForeignFileError, match="it is larger than 2 MB"):
        read_aadl([tmp_path / "m.aadl"])


def test_what_a_model_holds_is_bounded_over_all_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(aadl_import, "MAX_TOKENS", 100)
    files = [tmp_path / f"{name}.aadl" for name in "ab"]
    for file in files:
        data = " ".join(f"data d{index} end d{index};" for index in range(12))
        long_texts = "annex note {** " + "x; " * 1000 + "**}; -- " + "; " * 1000
        file.write_text(f"package {file.stem} public {long_texts}\n{data} end {file.stem};", encoding="utf-8")
    assert read_aadl(files[:1]).taken == {"data": 12}
    with pytest.raises(ForeignFileError, match="more than 100 words and signs") as told:
        read_aadl(files)
    assert (Path(told.value.span.file), told.value.span.line) == (files[1], 2)


def test_blanks_behind_the_last_word_that_fits_count_for_nothing() -> None:
    text = "data a end a;  -- as many as fit\n"
    assert [token.text for token in islice(scan_tokens(text, 5), 6)] == ["data", "a", "end", "a", ";", ""]
    with pytest.raises(TooManyTokensError):
        list(islice(scan_tokens(text, 4), 6))


def test_other_encodings_are_read_and_told(tmp_path: Path) -> None:
    text = 'package p public\n-- Höhe\nprocess p features x: out data port; properties archgen::Title => "Höhe"; end p; end p;'
    (tmp_path / "m.aadl").write_bytes(text.encode("cp1252"))
    imported = read_aadl([tmp_path / "m.aadl"])
    assert [note.kind for note in imported.notes] == ["encoding"]
    assert merge_slices(imported)["component_types"]["p"]["title"] == "Höhe"
    (tmp_path / "m.aadl").write_bytes(text.encode("utf-16"))
    assert merge_slices(read_aadl([tmp_path / "m.aadl"]))["component_types"]["p"]["title"] == "Höhe"


@pytest.mark.parametrize("share", [0.1, 0.3, 0.5, 0.7, 0.9, 0.99])
def test_half_a_file_is_read_as_far_as_it_goes(tmp_path: Path, share: float) -> None:
    text = (MODELS / "mobility_kit.aadl").read_text(encoding="utf-8")
    imported = import_text(tmp_path, text[: int(len(text) * share)])
    assert any(note.kind == "syntax" for note in imported.notes)


@pytest.mark.parametrize(
    "text",
    try_some(
        [
            "{**" * 30_000,
            '"a' * 50_001,
            "package p public data a properties x => " + "(" * 100_000,
            "package p public data a properties x => " + "[a => " * 30_000,
            "package p public data a properties x => " + "+-" * 50_000,
            "package p public data a properties x => " + "9" * 100_000,
            "package p public data a extends b " + "(a => data b " * 20_000,
            "package p public end " + "a." * 50_000,
            "package p public " + "end a.b " * 20_000,
            "package p public thread implementation a.b calls " + "x: { " * 20_000,
            "property set p is a: type " + "list of " * 30_000,
            "property set p is a: type " + "record (a: " * 30_000,
        ],
        3,
    ),
)
def test_what_is_too_deep_is_told_in_bounded_time(text: str) -> None:
    started = time.monotonic()
    assert list_faults(text)
    assert time.monotonic() - started < PATIENCE


def test_circles_end(tmp_path: Path) -> None:
    imported = import_package(
        tmp_path,
        """
        process a extends b features x: out data port; end a;
        process b extends c end b;
        process c extends a end c;
        feature group f features g: feature group f; end f;
        process d features g: feature group f; y: in data port; end d;
        data e end e;
        data implementation e.i subcomponents me: data e.i; end e.i;
        system s end s;
        system implementation s.i subcomponents t: system t.i; end s.i;
        system t end t;
        system implementation t.i subcomponents s: system s.i; p: process d; end t.i;
        """,
    )
    assert {note.kind for note in imported.notes} == {"extends", "feature group", "subcomponent"}
    assert "in the end" in " ".join(tell_notes(imported))


def test_parts_that_double_at_each_level_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for module in (aadl_import, hardware_mapping, system_walk):
        monkeypatch.setattr(module, "MAX_INSTANCES", 2000)
    levels = [
        f"system s{level} end s{level};\nsystem implementation s{level}.i subcomponents"
        f" a: system s{level + 1}.i; b: system s{level + 1}.i; end s{level}.i;"
        for level in range(30)
    ]
    last = "system s30 end s30; system implementation s30.i subcomponents p: process q; end s30.i; process q features x: out data port; end q;"
    with pytest.raises(ForeignFileError, match="more than 2,000 parts"):
        import_package(tmp_path, "\n".join([*levels, last]))


@pytest.mark.parametrize("parts", [("a",), ("a", "b")])
def test_ways_that_double_at_each_level_end(tmp_path: Path, parts: tuple[str, ...]) -> None:
    levels = [
        f"system s{level} features x: in event data port; y: in event data port; end s{level};"
        f" system implementation s{level}.i subcomponents {' '.join(f'{part}: system s{level + 1}.i;' for part in parts)}"
        f" connections {' '.join(f'port {way} -> {part}.{to};' for part in parts for way in 'xy' for to in 'xy')}"
        f" end s{level}.i;"
        for level in range(35)
    ]
    body = f"""
    {" ".join(levels)}
    process p features x: in event data port; y: in event data port; end p;
    process giver features x: out data port; end giver;
    system s35 features x: in event data port; y: in event data port; end s35;
    system implementation s35.i subcomponents p: process p; connections port x -> p.x; port y -> p.y; end s35.i;
    system robot end robot;
    system implementation robot.i
      subcomponents giver: process giver; top: system s0.i;
      connections c: port giver.x -> top.x {{topic_properties::Name => "/x";}};
    end robot.i;
    """
    if len(parts) > 1:
        with pytest.raises(ForeignFileError, match="more than 50,000 parts"):
            import_package(tmp_path, body)
    else:
        assert list(merge_slices(import_package(tmp_path, body))["nodes"]) == ["p", "giver"]


def test_a_daisy_chain_of_buses_is_cut_short() -> None:
    tree = HardwareTree()
    for index in range(100, 0, -1):
        tree.join((f"c{index}",), (f"c{index - 1}",))
    assert tree.find_root(("c100",)) == ("c0",)
    assert {tree.joined[f"c{index}",] for index in range(1, 101)} == {("c0",)}


def test_names_that_come_to_one_id_stay_apart(tmp_path: Path) -> None:
    imported = import_package(
        tmp_path,
        """
        process p features PointCloud: out data port; point_cloud: out data port; end p;
        process x features a: in data port; end x;
        system s end s;
        system implementation s.i subcomponents FrontLidar: process p; front_lidar: process p; end s.i;
        """,
    )
    sections = merge_slices(imported)
    assert list(sections["component_types"]["p"]["outputs"]) == ["point_cloud", "point_cloud_2"]
    assert list(sections["groups"]["s"]["components"]) == ["front_lidar", "front_lidar_2"]


def test_five_thousand_elements(tmp_path: Path) -> None:
    count = 500
    lines = [
        f"data D{i} end D{i}; thread t{i} features a: in event data port D{i}; b: out data port D{i}; end t{i};"
        f" process q{i} features a: in event data port D{i}; b: out data port D{i}; end q{i};"
        f" process implementation q{i}.i subcomponents t: thread t{i};"
        f" connections c: port a -> t.a; d: port t.b -> b; end q{i}.i;"
        for i in range(count)
    ]
    parts = " ".join(f"p{i}: process q{i}.i; c{i}: processor cpu;" for i in range(count))
    wires = " ".join(f"w{i}: port p{i}.b -> p{i + 1}.a;" for i in range(count - 1))
    bindings = " ".join(f"Actual_Processor_Binding => (reference (c{i})) applies to p{i};" for i in range(count))
    root = f"system implementation r.i subcomponents {parts} connections {wires} properties {bindings} end r.i;"
    started = time.monotonic()
    imported = import_package(tmp_path, "\n".join([*lines, "processor cpu end cpu; system r end r;", root]))
    assert time.monotonic() - started < PATIENCE
    assert len(merge_slices(imported)["nodes"]) == count
