"""New YAML documents in block style, as a person would write them, emitted by ruamel.yaml.

For what archgen writes anew from somebody's data. Files that exist are edited in place, as text (`archgen.edit`), and
what is thousands of lines long goes through `yaml_writer` (docs/decisions/0010-ruamel.md).
"""

from __future__ import annotations

import io
import textwrap
from collections.abc import Mapping

from ruamel.yaml import YAML
from ruamel.yaml.comments import CommentedMap, CommentedSeq
from ruamel.yaml.error import CommentMark
from ruamel.yaml.nodes import ScalarNode
from ruamel.yaml.representer import RoundTripRepresenter
from ruamel.yaml.scalarstring import DoubleQuotedScalarString, FoldedScalarString, LiteralScalarString
from ruamel.yaml.tokens import CommentToken

from archgen.diagnostics import replace_surrogates
from archgen.syntax import yaml_writer

_MAX_WIDTH = 110
"""The columns of a line; what is longer continues below."""
_INDENT = 2
_COMMENT_ABOVE, _COMMENT_BEHIND = 1, 2
"""The places of a key's comments in ruamel's list of four."""


class _OpenValue:
    """The value of a key that is still to be filled in: nothing stands behind its colon."""


class _DocumentRepresenter(RoundTripRepresenter):
    """Texts quoted where YAML 1.1 or 1.2 would misread them (ruamel.yaml knows 1.2 only), and no aliases."""

    def represent_str(self, data: str) -> ScalarNode:
        """Return a text, quoted by the rule that the other writers have."""
        text = replace_surrogates(data)
        style = '"' if yaml_writer.needs_quotes(text) else None
        return self.represent_scalar("tag:yaml.org,2002:str", text, style=style)

    def represent_none(self, data: None) -> ScalarNode:  # noqa: ARG002 - as ruamel.yaml calls it
        """Return `null`, which ruamel.yaml would leave out."""
        return self.represent_scalar("tag:yaml.org,2002:null", "null")

    def represent_open_value(self, _: _OpenValue) -> ScalarNode:
        """Return the empty scalar."""
        return self.represent_scalar("tag:yaml.org,2002:null", "")

    def ignore_aliases(self, data: object) -> bool:  # noqa: ARG002 - as ruamel.yaml calls it
        """Return True: the same list below two keys is written twice."""
        return True


_DocumentRepresenter.add_representer(str, _DocumentRepresenter.represent_str)
_DocumentRepresenter.add_representer(type(None), _DocumentRepresenter.represent_none)
_DocumentRepresenter.add_representer(_OpenValue, _DocumentRepresenter.represent_open_value)


class BlockMapping:
    """A mapping in block style that grows key by key, with comments and blank lines."""

    def __init__(self, depth: int = 0) -> None:
        """Begin an empty mapping, as deep in the document as `depth` keys."""
        self.content = CommentedMap()
        self._depth = depth

    def add_entry(self, key: str, value: object, hint: str = "") -> None:
        """Add a key: on one line where it fits, long text folded, long lists and mappings below.

        Without a value (None) nothing stands behind the colon but a hint: a comment on what belongs there.
        """
        self.content[key] = _OpenValue() if value is None else self._style_value(key, value)
        if value is None:
            self._add_hint(key, hint)

    def add_mapping(self, key: str, hint: str = "", *, is_spaced: bool = False) -> BlockMapping:
        """Add a mapping below a key and return it; with `is_spaced` a blank line precedes the key."""
        inner_mapping = BlockMapping(self._depth + 1)
        self.content[key] = inner_mapping.content
        self._add_hint(key, hint)
        if is_spaced:
            self._comments_of(key)[_COMMENT_ABOVE] = [CommentToken("\n", CommentMark(0))]
        return inner_mapping

    def _add_hint(self, key: str, hint: str) -> None:
        if hint:
            # ruamel.yaml puts one blank before a comment whose column lies behind it; the second one stands in it.
            self._comments_of(key)[_COMMENT_BEHIND] = CommentToken(f" {hint}\n", CommentMark(0))

    def _comments_of(self, key: str) -> list[object]:
        comments: list[object] = self.content.ca.items.setdefault(key, [None, None, None, None])
        return comments

    def _style_value(self, key: str, value: object) -> object:
        indent = _INDENT * self._depth
        line_width = indent + len(f"{yaml_writer.format_scalar(key)}: {yaml_writer.format_flow(value)}")
        is_wide = line_width > _MAX_WIDTH
        if isinstance(value, str):
            return _style_text(value, _MAX_WIDTH - indent - _INDENT) if is_wide or "\n" in value else value
        if is_wide and isinstance(value, Mapping):
            inner_mapping = BlockMapping(self._depth + 1)
            for inner_key, inner_value in value.items():
                inner_mapping.add_entry(inner_key, inner_value)
            return inner_mapping.content
        if is_wide and isinstance(value, (list, tuple)):
            return CommentedSeq([_copy_as_flow(item) for item in value])
        return _copy_as_flow(value)


def write_document(root: BlockMapping, header: str = "") -> str:
    """Write a document; `header` is the text of whole lines above it, comments as a rule."""
    # Nothing but the emitter is wanted: `YAML()` would look for plug-ins in its folder.
    writer = YAML(pure=True, plug_ins=[])
    writer.Representer = _DocumentRepresenter
    writer.indent(mapping=_INDENT, sequence=2 * _INDENT, offset=_INDENT)
    # Lines are broken here only, since ruamel.yaml breaks them behind the word that is too much.
    writer.width = 1 << 30
    stream = io.StringIO()
    writer.dump(root.content, stream)
    return header + stream.getvalue()


def _copy_as_flow(value: object) -> object:
    """Copy a value so that it is written on one line: mappings in braces, lists in brackets."""
    if isinstance(value, Mapping):
        flow_map = CommentedMap((_copy_as_flow(key), _copy_as_flow(item)) for key, item in value.items())
        flow_map.fa.set_flow_style()
        return flow_map
    if isinstance(value, (list, tuple)):
        flow_list = CommentedSeq(_copy_as_flow(item) for item in value)
        flow_list.fa.set_flow_style()
        return flow_list
    if isinstance(value, str) and yaml_writer.needs_quotes(value, in_flow=True):
        return DoubleQuotedScalarString(replace_surrogates(value))
    return value


def _style_text(text: str, width: int) -> object:
    """Return a long text in the style that shows it best: folded where single blanks separate its words, else literal,
    else quoted.
    """
    if text == " ".join(text.split()) and not yaml_writer.has_unsafe_characters(text):
        folded_text = FoldedScalarString(text)
        rows = textwrap.wrap(text, width, break_long_words=False, break_on_hyphens=False)
        # Where ruamel.yaml folds: at the one blank that follows each row but the last.
        folded_text.fold_pos = [sum(map(len, rows[: number + 1])) + number for number in range(len(rows) - 1)]
        return folded_text
    return LiteralScalarString(text) if yaml_writer.fits_literal_block(text) else text
