"""A folder of pictures, whose links lead to one another."""

from __future__ import annotations

from archgen.emit.picture import Picture
from archgen.emit.picture_files import build_picture_tree

SVG = b'<svg class="archgen"><a xlink:href="#%s">x</a></svg>'


def test_each_picture_is_a_file_for_each_format_that_was_drawn() -> None:
    pictures = {
        "overview": Picture("overview", 1, 1, b"<svg/>", png=b"png", dot="digraph {}"),
        "a/b": Picture("a/b", 1, 1),
    }
    tree = build_picture_tree(pictures, ("svg", "png", "pdf", "dot"))
    assert set(tree.files) == {"overview.svg", "overview.png", "overview.dot", "a/b.dot"}
    assert (tree.files["overview.png"], tree.files["overview.dot"]) == (b"png", b"digraph {}")


def test_links_lead_from_one_picture_to_the_other_and_nowhere_else() -> None:
    def draw(name: str, anchor: bytes) -> Picture:
        return Picture(name, 1, 1, SVG % anchor)

    pictures = {
        "overview": draw("overview", b"group:sensing"),
        "groups/sensing": draw("groups/sensing", b"component:sensing.camera"),
        "components/sensing.camera": draw("components/sensing.camera", b"node:camera"),
        "load/pc": draw("load/pc", b"host:pc"),
    }
    files = build_picture_tree(pictures, ("svg",)).files
    assert b'href="groups/sensing.svg"' in files["overview.svg"]
    assert b'href="../components/sensing.camera.svg"' in files["groups/sensing.svg"]
    assert b"href" not in files["components/sensing.camera.svg"]  # there is no picture of a node
    assert b"href" not in files["load/pc.svg"]  # it would lead to itself
