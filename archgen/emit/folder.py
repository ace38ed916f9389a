"""Write a folder of pictures: one file per picture and format. Links in an SVG lead to the other pictures of the
folder.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from archgen.emit import tree
from archgen.emit.picture import Picture
from archgen.emit.site import pictures as drawing

_FOLDERS = {"group": "groups", "component": "components", "view": "views", "chain": "chains", "host": "load"}
"""The folder of an element's picture, by the kind of element."""


def write(pictures: Mapping[str, Picture], forms: Sequence[str]) -> tree.FileTree:
    """Build the files of all pictures in these formats (`svg`, `png`, `pdf`, `dot`). Formats that were not drawn are
    left out.
    """
    found = ((f"{name}.{form}", _file(picture, form, pictures)) for name, picture in pictures.items() for form in forms)
    return tree.tree((path, data) for path, data in found if data is not None)


def _file(picture: Picture, form: str, others: Mapping[str, Picture]) -> bytes | None:
    if form == "dot":
        return picture.dot.encode()
    # The fields of Picture are called as the formats are.
    data: bytes | None = getattr(picture, form)
    if form != "svg" or data is None:
        return data
    up = "../" * picture.id.count("/")

    def href(anchor: str) -> str | None:
        kind, _, name = anchor.partition(":")
        at = f"{_FOLDERS.get(kind, kind)}/{name}"
        return f"{up}{at}.svg" if at in others and at != picture.id else None

    return drawing.alone(data, href)
