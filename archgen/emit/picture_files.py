"""Write a folder of pictures: one file per picture and format. Links in an SVG lead to the other pictures of the
folder, and its letters come with it: on other computers figures would be ragged in columns.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

from archgen.emit import file_tree
from archgen.emit.font_subset import embed_fonts
from archgen.emit.picture import Picture
from archgen.emit.safe_names import assign_safe_paths, is_safe_path
from archgen.emit.site import page_pictures as drawing
from archgen.views.shapes import split_anchor

_FOLDER_BY_KIND = {"group": "groups", "component": "components", "view": "views", "chain": "chains", "host": "load"}
"""The folder of an element's picture, by the kind of element."""


def build_picture_tree(pictures: Mapping[str, Picture], formats: Sequence[str]) -> file_tree.FileTree:
    """Build the files of all pictures in these formats (`svg`, `png`, `pdf`, `dot`). Formats that were not drawn are
    left out.
    """
    style = embed_fonts(picture.svg for picture in pictures.values() if picture.svg) if "svg" in formats else ""
    paths = _name_files(pictures)
    files = (
        (f"{paths[name]}.{form}", _picture_bytes(picture, form, paths, style))
        for name, picture in pictures.items()
        for form in formats
    )
    return file_tree.make_file_tree((path, data) for path, data in files if data is not None)


def _name_files(names: Collection[str]) -> Mapping[str, str]:
    """Return the paths of pictures without their endings: their names, unless some system would not take one, or two are one to it."""
    if all(map(is_safe_path, names)) and len(set(map(str.casefold, names))) == len(names):
        return {name: name for name in names}
    return assign_safe_paths(names)


def _picture_bytes(picture: Picture, format_name: str, paths: Mapping[str, str], style: str) -> bytes | None:
    if format_name == "dot":
        return picture.dot.encode()
    # The fields of Picture are called as the formats are.
    data: bytes | None = getattr(picture, format_name)
    if format_name != "svg" or data is None:
        return data
    prefix = "../" * picture.id.count("/")

    def href(anchor: str) -> str | None:
        kind, name = split_anchor(anchor)
        target = f"{_FOLDER_BY_KIND.get(kind, kind)}/{name}"
        return f"{prefix}{paths[target]}.svg" if target in paths and target != picture.id else None

    return drawing.standalone_svg(data, href, style)
