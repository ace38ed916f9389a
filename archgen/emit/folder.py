"""A folder of pictures: a file for each picture and format. The links of an SVG lead to the other pictures there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from archgen.emit import tree
from archgen.emit.picture import Picture
from archgen.emit.site import pictures as drawing

_FOLDERS = {"group": "groups", "component": "components", "view": "views", "chain": "chains", "host": "load"}
"""Where the picture of an element lies, by the sort of element."""


def write(pictures: Mapping[str, Picture], forms: Sequence[str]) -> tree.FileTree:
    """Make the files of pictures, in the formats that were drawn."""
    found = ((f"{name}.{form}", _file(picture, form, pictures)) for name, picture in pictures.items() for form in forms)
    return tree.tree((path, data) for path, data in found if data is not None)


def _file(picture: Picture, form: str, others: Mapping[str, Picture]) -> bytes | None:
    if form == "dot":
        return picture.dot.encode()
    data: bytes | None = getattr(picture, form)
    if form != "svg" or data is None:
        return data
    up = "../" * picture.id.count("/")

    def href(anchor: str) -> str | None:
        kind, _, name = anchor.partition(":")
        at = f"{_FOLDERS.get(kind, kind)}/{name}"
        return f"{up}{at}.svg" if at in others and at != picture.id else None

    return drawing.alone(data, href)
