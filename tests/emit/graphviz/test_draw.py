"""Drawing as a whole: workers that break, a library that is missing, the cache, the formats, the same bytes."""

from __future__ import annotations

import os
import re
import struct
import sys
import zlib
from dataclasses import replace
from pathlib import Path

import pytest

from archgen.emit.graphviz import (
    PICTURE_FORMATS,
    MissingGraphviz,
    dark_rules,
    draw_pictures,
    font_config,
    picture_cache,
    png_writer,
    start_early_workers,
    worker_pool,
)
from archgen.emit.graphviz.drawing_worker import DrawingFailure, DrawingTask
from archgen.emit.graphviz.worker_pool import DrawingWorker
from archgen.emit.picture import Picture
from archgen.views.graphs import draw_component, draw_group, draw_overview
from archgen.views.lookup import make_lookup
from archgen.views.picture_shapes import Arrow, Box, Graph
from tests.architectures import robot
from tests.property_sizes import try_some

VIEW = make_lookup(robot(1))
GRAPHS = (draw_overview(VIEW), draw_group(VIEW, "human_state"), draw_component(VIEW, "human_state.fall_detector"))
TINY = Graph(
    "tiny",
    "Tiny",
    "flow",
    (Box("a", "A", ref="component:a"), Box("b", "B")),
    (Arrow("x", "a", "b", "Data"),),
    kind="component",
)


def test_all_formats() -> None:
    (made,) = draw_pictures((TINY,), PICTURE_FORMATS, resolve_link=lambda ref: f"#{ref}").values()
    assert made.warning is None
    assert (made.svg or b"").startswith(b'<svg class="archgen" role="group" ')
    assert b'xlink:href="#component:a"' in (made.svg or b"")
    assert b"<text" not in (made.svg_outlines or b"<text"), "outlines need no font"
    assert (made.pdf or b"").startswith(b"%PDF-")
    assert b"20000101000000" in (made.pdf or b"")
    assert (made.png or b"")[:8] == b"\x89PNG\r\n\x1a\n"
    width, _ = struct.unpack(">II", (made.png or b"")[16:24])
    assert abs(width / (made.width + 14) - 144 / 72) < 0.1, "144 dots per inch"
    assert made.dot.startswith('digraph "tiny" {')


def test_only_what_is_asked_for() -> None:
    made = draw_pictures((TINY,), ("png",), resolve_link=lambda _: None)["tiny"]
    assert (made.svg, made.svg_outlines, made.pdf) == (None, None, None)
    assert made.png


def test_the_same_bytes_with_any_number_of_workers() -> None:
    one = draw_pictures(GRAPHS, PICTURE_FORMATS, resolve_link=lambda _: None, workers=1)
    two = draw_pictures(GRAPHS[::-1], PICTURE_FORMATS, resolve_link=lambda _: None, workers=2)
    assert list(one) == ["overview", "groups/human_state", "components/human_state.fall_detector"]
    assert one == {name: two[name] for name in one}


def test_progress() -> None:
    told: list[tuple[int, int]] = []
    draw_pictures(
        GRAPHS,
        ("svg",),
        resolve_link=lambda _: None,
        workers=2,
        progress=lambda done, total: told.append((done, total)),
    )
    assert told == [(1, 3), (2, 3), (3, 3)]


def test_ids_and_classes_are_hooks_for_a_page() -> None:
    svg = (draw_pictures(GRAPHS, ("svg",), resolve_link=lambda _: None)["groups/human_state"].svg or b"").decode()
    assert re.search(r'<g id="groups-human_state-n0" class="node box \w+ normal', svg)
    assert re.search(r'<g id="groups-human_state-e0" class="edge arrow \w+"', svg)
    assert "<title>Human State</title>" in svg
    assert [text for text in re.findall(r"<text[^>]*>", svg) if ' fill="#' not in text] == []
    colours = set(re.findall(r'(?:fill|stroke)="(#[0-9a-f]{6})"', svg))
    rules = dark_rules("")
    assert [colour for colour in sorted(colours) if colour not in rules] == []


# A worker that dies, sleeps or gives up when the picture is not the simple one, as the real one might.
BROKEN = """
import sys, os, time; sys.path.append({root!r})
from archgen.emit.graphviz import drawing_worker
true = drawing_worker._draw_task
def done(task):
    if task.drawing.id == "tiny" and {when}: {what}
    return true(task)
drawing_worker._draw_task = done
drawing_worker.main()
"""


def broken(what: str, when: str = "not task.simple") -> tuple[str, ...]:
    root = str(Path(worker_pool.__file__).parents[3])
    return (sys.executable, "-P", "-c", BROKEN.format(root=root, what=what, when=when))


@pytest.mark.usefixtures("fresh_workers")
@pytest.mark.parametrize(
    ("what", "said"),
    try_some(
        [
            ("os.abort()", "Graphviz broke down"),
            ("time.sleep(600)", "it took longer than 1 s"),
            (
                "drawing_worker.PROCESSOR_SECONDS = 0; drawing_worker._limit_processor_time(); [1 for _ in iter(int, 1)]",
                "it took longer than 30 s of the processor",
            ),
            ("return drawing_worker.DrawingFailure('layout', '1 of 2 arrows were lost')", "1 of 2 arrows were lost"),
        ],
        2,
    ),
)
def test_a_broken_worker_costs_one_picture(
    what: str, said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    request_picture = worker_pool.DrawingWorker.request_picture

    def request_in_time(worker: DrawingWorker, task: DrawingTask, timeout: float) -> Picture | DrawingFailure:
        is_late = "sleep" in what and task.drawing.id == "tiny" and not task.simple
        return request_picture(worker, task, 1 if is_late else timeout)

    monkeypatch.setattr(worker_pool.DrawingWorker, "request_picture", request_in_time)
    tasks = [DrawingTask(graph, {}, ("svg",)) for graph in (TINY, replace(TINY, id="other"))]
    tiny, other = worker_pool.draw_tasks(tasks, tmp_path, workers=1, timeout=600, command_line=broken(what))
    assert tiny.warning == f"the picture tiny is drawn in a simpler way: {said}"
    assert tiny.svg
    assert (other.warning, other.id) == (None, "other")


@pytest.mark.usefixtures("fresh_workers")
def test_a_picture_that_cannot_be_drawn_at_all(tmp_path: Path) -> None:
    start = broken("os.abort()", "True")
    tiny, other = worker_pool.draw_tasks(
        [DrawingTask(TINY, {}, ("svg",)), DrawingTask(GRAPHS[2], {}, ("svg",))], tmp_path, workers=1, command_line=start
    )
    assert tiny.svg is None
    assert tiny.warning == "the picture tiny is missing: Graphviz broke down"
    assert other.svg


@pytest.mark.usefixtures("fresh_workers")
def test_a_missing_library_is_named(tmp_path: Path) -> None:
    message = "libXrender.so.1: cannot open shared object file: No such file or directory"
    code = f"import sys; sys.modules['pygraphviz'] = None\nclass F:\n  def find_spec(s, n, *a):\n    if n == 'pygraphviz': raise ImportError({message!r})\ndel sys.modules['pygraphviz']; sys.meta_path.insert(0, F())\n"
    root = str(Path(worker_pool.__file__).parents[3])
    code += f"sys.path.append({root!r})\nfrom archgen.emit.graphviz.drawing_worker import main; main()"
    with pytest.raises(MissingGraphviz) as raised:
        worker_pool.draw_tasks(
            [DrawingTask(TINY, {}, ("svg",))], tmp_path, workers=1, command_line=(sys.executable, "-P", "-c", code)
        )
    assert str(raised.value) == (
        "pictures need the system package libxrender1 (or what it is called here): libXrender.so.1: cannot open shared "
        "object file: No such file or directory. "
        "On Debian and Ubuntu: apt-get install libglib2.0-0 libx11-6 libxext6 libxrender1 libexpat1"
    )


def test_what_else_can_be_missing() -> None:
    assert worker_pool.explain_missing("No module named 'pygraphviz'") == (
        "pictures need pygraphviz, which cannot be imported: No module named 'pygraphviz'"
    )


def no_workers(*_: object, **__: object) -> tuple[()]:
    pytest.fail("something was drawn anew")


def test_the_second_time_comes_from_the_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first = draw_pictures(GRAPHS, PICTURE_FORMATS, resolve_link=lambda _: None, cache=tmp_path)
    monkeypatch.setattr("archgen.emit.graphviz.draw_all", no_workers)
    assert draw_pictures(GRAPHS, PICTURE_FORMATS, resolve_link=lambda _: None, cache=tmp_path) == first
    some = draw_pictures(GRAPHS, ("png",), resolve_link=lambda _: None, cache=tmp_path)["overview"]
    assert (some.png, some.svg) == (first["overview"].png, None)


def test_each_picture_may_have_formats_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    other = replace(TINY, id="other")
    formats = {"tiny": ("svg",), "other": ("png", "svg_outlines")}
    made = draw_pictures((TINY, other), formats, resolve_link=lambda _: None, cache=tmp_path)
    drawn = {
        name: {form for form in ("svg", "svg_outlines", "png", "pdf") if getattr(picture, form)}
        for name, picture in made.items()
    }
    assert drawn == {name: set(each) for name, each in formats.items()}
    monkeypatch.setattr("archgen.emit.graphviz.draw_all", no_workers)
    assert draw_pictures((other, TINY), formats, resolve_link=lambda _: None, cache=tmp_path) == made


@pytest.mark.parametrize(
    "change",
    [replace(TINY, title="Other"), replace(TINY, boxes=TINY.boxes[:1], arrows=())],
)
def test_what_changed_is_drawn_anew(change: Graph, tmp_path: Path) -> None:
    before = draw_pictures((TINY,), ("svg",), resolve_link=lambda _: None, cache=tmp_path)["tiny"]
    after = draw_pictures((change,), ("svg",), resolve_link=lambda _: None, cache=tmp_path)["tiny"]
    assert before.svg != after.svg
    assert (
        draw_pictures((TINY,), ("svg",), resolve_link=lambda ref: f"#{ref}", cache=tmp_path)["tiny"].svg != before.svg
    )


def test_what_nobody_sees_draws_nothing_anew(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    draw_pictures((TINY,), ("svg", "png"), resolve_link=lambda _: None, cache=tmp_path)
    monkeypatch.setattr("archgen.emit.graphviz.draw_all", no_workers)
    boxes = tuple(replace(box, tooltip='</title><b onclick="x">\nsecond', ref="page") for box in TINY.boxes)
    arrows = tuple(replace(arrow, flows=("archgen.tip/b0 & more",), ref=None) for arrow in TINY.arrows)
    told = replace(TINY, boxes=boxes, arrows=arrows, alt="Two <boxes>")
    made = draw_pictures((told,), ("svg", "png", "dot"), resolve_link=lambda _: 'a"b.html', cache=tmp_path)["tiny"]
    svg = (made.svg or b"").decode()
    assert svg.count("<title>&lt;/title&gt;&lt;b onclick=&quot;x&quot;&gt;&#10;second</title>") == len(boxes)
    assert svg.count('<a xlink:href="a&quot;b.html"') == len(boxes)
    assert "<desc>Two &lt;boxes&gt;</desc>" in svg
    assert "<title>archgen.tip/b0 &amp; more</title>" in svg
    assert 'URL="a\\"b.html"' in made.dot
    assert "second" in made.dot


@pytest.mark.parametrize("damage", [b"", b"{}\n", b'{"parts": 3}\n', b"\xff\xfe", b"[]\n"])
def test_a_damaged_cache_is_not_taken(damage: bytes, tmp_path: Path) -> None:
    first = draw_pictures((TINY,), ("svg",), resolve_link=lambda _: None, cache=tmp_path)
    (kept,) = tmp_path.glob("*.picture")
    kept.write_bytes(damage)
    assert draw_pictures((TINY,), ("svg",), resolve_link=lambda _: None, cache=tmp_path) == first
    whole = kept.read_bytes()
    kept.write_bytes(whole[:-9] + b"malicious")
    assert draw_pictures((TINY,), ("svg",), resolve_link=lambda _: None, cache=tmp_path) == first


def test_a_cache_that_cannot_be_written_is_done_without(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    assert draw_pictures((TINY,), ("svg",), resolve_link=lambda _: None, cache=tmp_path / "file" / "cache")["tiny"].svg


def test_old_pictures_go(tmp_path: Path) -> None:
    for at in range(150):
        (tmp_path / f"{at}.picture").write_bytes(b"")
    picture_cache.prune_pictures(tmp_path, 5)
    assert len(list(tmp_path.iterdir())) == 120


def test_pictures_with_a_warning_are_not_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(worker_pool, "worker_command", lambda: broken("os.abort()"))
    assert draw_pictures((TINY,), ("svg",), resolve_link=lambda _: None, cache=tmp_path)["tiny"].warning
    assert not list(tmp_path.glob("*.picture"))


def test_the_font_lies_beside_its_licence() -> None:
    names = sorted(file.name for file in font_config.FONT_FOLDER.iterdir())
    assert names == [
        "DejaVuSans-Bold.ttf",
        "DejaVuSans.ttf",
        "Inter-Bold.ttf",
        "Inter-Regular.ttf",
        "LICENSE.DejaVu",
        "LICENSE.Inter",
    ]


def _plain_pixels(width: int, colours: list[bytes]) -> bytes:
    """Return a gd file of true colours."""
    height = len(colours) // width
    return (
        b"\xff\xfe" + struct.pack(">HH", width, height) + b"\1\x7f\xff\xff\xfe" + b"".join(b"\0" + c for c in colours)
    )


def _unpack_png(data: bytes) -> list[bytes]:
    """Return the colours of a PNG with a palette and without filters, row by row."""
    width, height = struct.unpack(">II", data[16:24])
    palette = data[data.index(b"PLTE") + 4 :]
    start = data.index(b"IDAT") + 4
    (length,) = struct.unpack(">I", data[start - 8 : start - 4])
    lines = zlib.decompress(data[start : start + length])
    size = len(lines) // height
    rows = [lines[at + 1 : at + size] for at in range(0, len(lines), size)]
    if data[24] == 4:  # two pixels in a byte
        rows = [bytes(half for pair in row for half in (pair >> 4, pair & 15))[:width] for row in rows]
    return [palette[3 * index : 3 * index + 3] for row in rows for index in row]


def test_colours_of_the_drawing_stay_exact_and_others_are_taken_together() -> None:
    tints = [bytes.fromhex(colour) for colour in ("f3f2f0", "f7f0f5", "f2f3f4", "ffffff")]
    smooth = [bytes.fromhex(colour) for colour in ("808080", "818283", "9f9f9f", "707070")]
    data = png_writer.index_pixels(_plain_pixels(4, tints + smooth), frozenset(tints))
    assert data
    grey = smooth[0]
    assert _unpack_png(data) == [*tints, grey, grey, grey, smooth[3]]


def test_few_colours_take_half_a_byte_and_the_rarest_shades_become_their_neighbours() -> None:
    own = [bytes.fromhex(colour) for colour in ("f3f2f0", "0072b2")]
    shades = [bytes((0, 0, 32 * step)) for step in range(8)] + [bytes((0, 32 * step, 0)) for step in range(1, 7)]
    rare = bytes((0, 32, 32))
    row = [*own, *shades, rare]
    data = png_writer.index_pixels(_plain_pixels(17, row), frozenset(own))
    assert data
    assert data[24] == 4
    colours = _unpack_png(data)
    assert colours[:16] == row[:16]
    assert colours[16] in {shades[1], shades[8]}


def test_where_the_drawing_has_many_colours_none_is_given_up() -> None:
    own = [bytes((18 * step, 0, 0)) for step in range(13)]
    data = png_writer.index_pixels(_plain_pixels(13, own), frozenset(own))
    assert data
    assert (data[24], _unpack_png(data)) == (8, own)


def test_more_than_256_colours_have_no_palette() -> None:
    colours = [bytes((red, green, 0)) for red in range(17) for green in range(16)]
    assert png_writer.index_pixels(_plain_pixels(16, colours), frozenset(colours)) is None
    assert png_writer.index_pixels(_plain_pixels(16, colours), frozenset()) is not None


def test_a_png_has_each_fill_as_it_is_in_the_svg() -> None:
    made = draw_pictures(GRAPHS, ("svg", "png"), resolve_link=lambda _: None)
    for picture in made.values():
        # Heads of arrows have the colour of their line: few of their pixels are of them alone.
        fills = set(re.findall(rb'<(?:path|polygon)[^>]* fill="#([0-9a-f]{6})"(?! stroke="#\1")', picture.svg or b""))
        assert fills
        assert {bytes.fromhex(fill.decode()) for fill in fills} <= set(_unpack_png(picture.png or b""))


@pytest.mark.usefixtures("fresh_workers")
def test_workers_start_early_where_no_picture_is_kept_and_draw(tmp_path: Path) -> None:
    with start_early_workers(tmp_path) as ready:
        processes = [each.start_process() for each in ready]
        assert len(processes) == os.cpu_count()
        drawn = draw_pictures(GRAPHS, ("svg",), resolve_link=lambda _: None, cache=tmp_path, ready_workers=ready)
    assert all(picture.svg for picture in drawn.values())
    assert all(process.returncode is not None for process in processes)
    with start_early_workers(tmp_path) as ready:
        assert list(ready) == []
    with start_early_workers(None) as ready:
        assert list(ready) == []


@pytest.mark.usefixtures("fresh_workers")
def test_more_workers_than_pictures_are_ended(tmp_path: Path) -> None:
    with start_early_workers(tmp_path) as ready:
        processes = [each.start_process() for each in ready]
        assert draw_pictures([TINY], ("svg",), resolve_link=lambda _: None, cache=tmp_path, ready_workers=ready)[
            "tiny"
        ].svg
    assert all(process.returncode is not None for process in processes)


def test_a_full_disk_costs_no_picture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(picture_cache, "store_picture", full)
    assert draw_pictures([TINY], ("svg",), resolve_link=lambda _: None, cache=tmp_path)["tiny"].svg
