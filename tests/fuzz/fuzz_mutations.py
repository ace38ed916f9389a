"""Change inputs by their grammar: trees of XML, YAML and Python, members of archives, words of lines, launch expressions.

A change leaves most of an input sound, so that it passes the parser and meets what stands behind it.
"""

from __future__ import annotations

import ast
import copy
import io
import math
import random
import re
import warnings
import zipfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from typing import Any

import yaml
from lxml import etree

SEPARATOR = b"\n%%%%\n"
"""Between the parts of an input that has several."""
ODD_TEXTS = (
    *("", " ", "0", "-1", "1e999", "nan", "-.inf", "0x10", "1_0", "~", "null", "true", "2026-01-01", "=", "<<", "*", "&a"),
    *("\0", "\t", "\r", "\u2028", "\ufeff", "\ud800", "é", "\u0130", "٣", "²", "a" * 300, "../..", "/", "//", "a//b", "a/", ".", "..", "~/x", "C:\\"),
    *("$(var )", "$(arg )", "$(env )", "$(find )", "$(eval )", "$(not )", "$(equals )", "$(and )", "$(if )", "$(", "$()", ")", "$($(var a))"),
    *("$(eval 1/0)", "$(eval 10**10)", "$(find-pkg-share )", "$(dirname)", "$(anon )", "$(optenv A b)", "$(command 'a')", "$(textsubst )"),
    *("{{", "}}", "{% raw %}", "${x}", "%s", "{0}", "[", "]", "{", "}", ":", "- ", "#", "'", '"', "\\", "|", ">", "!!", "!!int a", "@", "`"),
    *("self", "self.x", "a.b.c", "*.x", "-x", "+", "a+", "a..b", "..", "tag:", "owner:x", "is:", "1 Hz", "0 Hz", "1 ms", "-5 ms", "99999999999 s"),
    *("1/0", "9" * 5000, "0." + "0" * 400 + "1", "1e-400", "5 %", "100 %", "int32[]", "string<=3[<=2]", "a/B", "a/msg/B", "1.5.2", "v1"),
)  # fmt: skip
Draw = random.Random


def mutate_input(kinds: Sequence[str], data: bytes, words: Sequence[str], draw: Draw) -> bytes:
    """Return an input with one to four changes, each in one of its parts, by the part's kind."""
    parts = data.split(SEPARATOR)
    parts += [b""] * (len(kinds) - len(parts))
    for _ in range(draw.choice((1, 1, 1, 2, 2, 3, 4))):
        index = draw.choices(range(len(kinds)), [_PART_WEIGHTS.get(kind, 10) for kind in kinds])[0]
        parts[index] = _mutate_part(kinds[index], parts[index], words, draw)
    return SEPARATOR.join(parts[: len(kinds)])


_PART_WEIGHTS = {"choice": 2}


def _mutate_part(kind: str, data: bytes, words: Sequence[str], draw: Draw) -> bytes:
    if kind == "choice":
        return str(draw.randrange(256)).encode()
    # One in eight as lines, so that what the parsers themselves refuse is tried, too.
    if kind in _BY_TREE and draw.randrange(8):
        # Whatever the libraries of the fuzzer itself say of a broken tree: then it is changed as text.
        with suppress(Exception):
            return _BY_TREE[kind](data, words, draw)
    return _mutate_lines(data, words, draw) if kind != "zip" and draw.randrange(10) else _mutate_bytes(data, draw)


def mutate_text(text: str, words: Sequence[str], draw: Draw) -> str:
    """Return a text with one change: another one in its place, a piece of it gone, doubled or replaced."""
    way = draw.randrange(9) if text else 0
    first, last = sorted(draw.randrange(len(text) + 1) for _ in range(2))
    if way == 0:
        changed = draw.choice(ODD_TEXTS)
    elif way == 1 and words:
        changed = draw.choice(words)
    elif way == 2:
        changed = text[:first] + text[last:]
    elif way == 3:
        changed = text[:last] + text[first:last] * draw.choice((1, 2, 40)) + text[last:]
    elif way == 4:
        changed = text[:first] + draw.choice(ODD_TEXTS) + text[first:]
    elif way == 5:
        # An expression loses what stands in it, or stands in another one.
        emptied = re.sub(r"\$\(([\w-]+)[^()]*\)", r"$(\1 )", text, count=1)
        changed = emptied if draw.randrange(2) else f"$(eval {text})"
    else:
        changed = _mutate_pieces(re.split(r"(\w+|\s+)", text), words, draw)
    return changed


def _mutate_pieces(pieces: list[str], words: Sequence[str], draw: Draw) -> str:
    index, way = draw.randrange(len(pieces)), draw.randrange(3)
    if way == 0:
        del pieces[index]
    elif way == 1:
        pieces[index] = draw.choice(words) if words and draw.randrange(3) else draw.choice(ODD_TEXTS)
    else:
        pieces.insert(index, draw.choice(pieces))
    return "".join(pieces)


def _mutate_bytes(data: bytes, draw: Draw) -> bytes:
    changed = bytearray(data)
    for _ in range(draw.choice((1, 1, 2, 8))):
        place = draw.randrange(len(changed) + 1)
        way = draw.randrange(4)
        if way == 0 and place < len(changed):
            changed[place] = draw.randrange(256)
        elif way == 1:
            changed[place:place] = draw.randbytes(draw.choice((1, 2, 4)))
        elif way == 2:
            del changed[place : place + draw.choice((1, 4, 64))]
        else:
            changed[place:place] = changed[place // 2 : place // 2 + 32]
    return bytes(changed)


def _mutate_lines(data: bytes, words: Sequence[str], draw: Draw) -> bytes:
    lines = data.decode("utf-8", "surrogateescape").split("\n")
    index, other = (draw.randrange(len(lines)) for _ in range(2))
    way = draw.randrange(8)
    if way == 0:
        del lines[index]
    elif way == 1:
        lines.insert(index, lines[other])
    elif way == 2:
        lines[index], lines[other] = lines[other], lines[index]
    elif way == 3:
        first, last = sorted((index, other))
        lines[last:last] = lines[first : min(last, first + 20)] * draw.choice((1, 1, 3))
    else:
        lines[index] = mutate_text(lines[index], words, draw)
    return (
        "\n".join(lines).encode("utf-8", "surrogatepass" if draw.randrange(2) else "surrogateescape")
        if _is_sound(lines)
        else _mutate_bytes(data, draw)
    )


def _is_sound(lines: Sequence[str]) -> bool:
    return not any("\ud800" <= character <= "\udfff" for line in lines for character in line)


def _mutate_xml(data: bytes, words: Sequence[str], draw: Draw) -> bytes:
    root = etree.fromstring(data, etree.XMLParser(recover=True, resolve_entities=False, no_network=True))
    if root is None:
        return _mutate_lines(data, words, draw)
    elements = [element for element in root.iter() if isinstance(element.tag, str)]
    element, other = draw.choice(elements), draw.choice(elements)
    parent, way = element.getparent(), draw.randrange(9)
    if way == 0 and parent is not None:
        parent.remove(element)
    elif way == 1 and parent is not None:
        parent.insert(draw.randrange(len(parent) + 1), copy.deepcopy(element))
    elif way == 2 and element not in other.iterancestors() and len(etree.tostring(element)) < 5000:
        other.insert(draw.randrange(len(other) + 1), copy.deepcopy(element))
    elif way == 3:
        element.tag = other.tag
    elif way == 4 and element.attrib:
        del element.attrib[draw.choice(list(element.attrib))]
    elif way == 5 and other.attrib:
        name = draw.choice(list(other.attrib))
        element.attrib[name] = other.attrib[name]
    elif way == 6:
        element.text = _xml_text(mutate_text(element.text or "", words, draw))
    elif element.attrib:
        name = draw.choice(list(element.attrib))
        element.attrib[name] = _xml_text(mutate_text(str(element.attrib[name]), words, draw))
    else:
        element.tag = re.sub(r"\W", "", draw.choice(words) if words else "x") or "x"
    return bytes(etree.tostring(root))


def _xml_text(text: str) -> str:
    return "".join(
        character
        for character in text
        if character in "\t\n" or (character >= " " and not "\ud800" <= character <= "\udfff" and character < "\ufffe")
    )


def _mutate_yaml(data: bytes, words: Sequence[str], draw: Draw) -> bytes:
    tree = yaml.load(data, yaml.CSafeLoader)
    places = list(_list_places(tree))
    if not places:
        return _mutate_lines(data, words, draw)
    _change_tree(places, words, draw)
    flow = draw.choice((None, None, False, True))
    text: str = yaml.dump(tree, Dumper=yaml.CSafeDumper, sort_keys=False, allow_unicode=True, default_flow_style=flow)
    return text.encode("utf-8", "replace")


def _change_tree(places: Sequence[tuple[Any, Any]], words: Sequence[str], draw: Draw) -> None:
    (holder, key), (other_holder, other_key) = draw.choice(places), draw.choice(places)
    way = draw.randrange(9)
    if way == 0:
        del holder[key]
    elif way == 1:
        holder[key] = copy.deepcopy(other_holder[other_key])
    elif way == 2 and isinstance(holder, dict):
        holder[_mutate_key(key, words, draw)] = holder.pop(key)
    elif way == 3 and isinstance(other_holder, dict) and isinstance(holder[key], dict):
        holder[key][other_key] = copy.deepcopy(other_holder[other_key])
    elif way == 4:
        odd: tuple[Any, ...] = (
            None,
            [],
            {},
            [holder[key]],
            {"x": holder[key]},
            True,
            0,
            -1,
            1.5,
            10**30,
            math.inf,
            "",
            [None],
            [[]],
        )
        holder[key] = draw.choice(odd)
    elif way == 5 and isinstance(holder, list):
        holder.insert(draw.randrange(len(holder) + 1), copy.deepcopy(draw.choice(holder)))
    else:
        leaves = [(held, each) for held, each in places if not isinstance(held[each], dict | list)]
        holder, key = draw.choice(leaves or places)
        holder[key] = mutate_text(str(holder[key]), words, draw)


def _mutate_key(key: object, words: Sequence[str], draw: Draw) -> Any:  # noqa: ANN401 - keys of YAML are anything
    return draw.choice((None, 1, True, 1.5)) if not draw.randrange(8) else mutate_text(str(key), words, draw)


def _list_places(tree: Any) -> Iterator[tuple[Any, Any]]:  # noqa: ANN401 - data of YAML
    """Yield each mapping and list with each of its keys; what aliases say again is walked through once."""
    waiting, seen = [tree], set()
    while waiting:
        held = waiting.pop()
        if not isinstance(held, dict | list) or id(held) in seen:
            continue
        seen.add(id(held))
        for key in list(held) if isinstance(held, dict) else range(len(held)):
            yield held, key
            waiting.append(held[key])


_ODD_EXPRESSIONS = (
    "x", "None", "[]", "()", "{}", "''", "b''", "0", "-1", "1e400", "10**9", "1j", "...", "lambda: 0", "[x for x in y]", "f'{x}'", "f'{x!r:>{y}}'",
    "x[0]", "x[:]", "x['a']", "x()", "x(*y)", "x(**y)", "x.y", "not x", "x if y else z", "x and y", "x in y", "[*x]", "{**x}", "x % ()", "'%s %d' % x",
    "'a'.join(x)", "'a'.split('')", "'{}'.format()", "str(x)", "int('x')", "open('x')", "os.environ['A']", "os.path.join()", "dict(x)", "zip(x, x)",
    "[x, x]", "x + x", "x * 99999", "x == x", "(y := x)", "LaunchDescription(x)", "LaunchConfiguration()", "Node()", "Node(x)", "IfCondition()",
    "PythonExpression(x)", "PathJoinSubstitution(x)", "TextSubstitution()", "GroupAction(x)", "OpaqueFunction(function=x)", "next(iter(x))", "max([])",
    "range(10**9)", "x[1:2:0]", "sorted(x)", "list(map(x, y))", "{x for x in y}", "{x: y for x, y in z}", "x < y < z", "x @ y", "x // 0", "x << 99", "''[5]",
)  # fmt: skip


def _mutate_python(data: bytes, words: Sequence[str], draw: Draw) -> bytes:
    tree = ast.parse(data)
    bodies = [
        body
        for node in ast.walk(tree)
        for body in (getattr(node, "body", None), getattr(node, "orelse", None))
        if isinstance(body, list) and body
    ]
    places = [(node, name, index) for node in ast.walk(tree) for name, index in _list_expression_places(node)]
    way = draw.randrange(8)
    if way < 3 and bodies:
        body, other = draw.choice(bodies), draw.choice(bodies)
        if way == 0:
            del body[draw.randrange(len(body))]
            body[:] = body or [ast.Pass()]
        else:
            body.insert(draw.randrange(len(body) + 1), copy.deepcopy(draw.choice(other)))
    elif places:
        node, name, index = draw.choice(places)
        donor_node, donor_name, donor_index = draw.choice(places)
        old, donor = _get_place(node, name, index), _get_place(donor_node, donor_name, donor_index)
        new: Any = copy.deepcopy(donor)
        if way == 3 or not isinstance(old, ast.expr):
            new = ast.parse(draw.choice(_ODD_EXPRESSIONS), mode="eval").body
        elif way in {4, 5} and isinstance(old, ast.Constant):
            new = (
                ast.Constant(mutate_text(str(old.value), words, draw))
                if draw.randrange(4)
                else ast.Constant(draw.choice((0, -1, 10**30, 1.5, None, True, "", b"x")))
            )
        elif way == 6:
            new = draw.choice(
                (
                    lambda: ast.List([old, old], ast.Load()),
                    lambda: ast.Call(donor, [old], []),
                    lambda: ast.Subscript(old, donor, ast.Load()),
                    lambda: ast.BinOp(old, ast.Add(), donor),
                    lambda: ast.Starred(old, ast.Load()),
                    lambda: ast.Attribute(old, "x", ast.Load()),
                )
            )()
        _set_place(node, name, index, new)
    return ast.unparse(ast.fix_missing_locations(tree)).encode("utf-8", "replace")


def _list_expression_places(node: ast.AST) -> list[tuple[str, int]]:
    found = []
    for name, value in ast.iter_fields(node):
        if isinstance(value, ast.expr):
            found.append((name, -1))
        elif isinstance(value, list):
            found += [(name, index) for index, item in enumerate(value) if isinstance(item, ast.expr)]
    return found


def _get_place(node: ast.AST, name: str, index: int) -> Any:  # noqa: ANN401 - whatever stands there
    return getattr(node, name) if index < 0 else getattr(node, name)[index]


def _set_place(node: ast.AST, name: str, index: int, value: object) -> None:
    if index < 0:
        setattr(node, name, value)
    else:
        getattr(node, name)[index] = value


def _mutate_zip(data: bytes, words: Sequence[str], draw: Draw) -> bytes:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        members = [(info.filename, archive.read(info)) for info in archive.infolist()]
    index = draw.randrange(len(members))
    name, content = members[index]
    way = draw.randrange(12)
    if way == 0:
        del members[index]
    elif way == 1:
        members.insert(index, (draw.choice(members)[0], content))
    elif way == 2:
        members[index] = (mutate_text(name, words, draw).replace("\0", "")[:200] or "x", content)
    else:
        members[index] = (name, _mutate_part("xml" if content.lstrip()[:1] == b"<" else "lines", content, words, draw))
    return write_zip(members)


def write_zip(members: Sequence[tuple[str, bytes]]) -> bytes:
    """Return an archive; it takes two members of one name."""
    stream = io.BytesIO()
    with warnings.catch_warnings(), zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        warnings.simplefilter("ignore", UserWarning)
        for name, content in members:
            archive.writestr(zipfile.ZipInfo(name, (2026, 1, 1, 0, 0, 0)), content)
    return stream.getvalue()


_BY_TREE: dict[str, Callable[[bytes, Sequence[str], Draw], bytes]] = {
    "xml": _mutate_xml,
    "yaml": _mutate_yaml,
    "python": _mutate_python,
    "zip": _mutate_zip,
}


def list_words(seeds: Sequence[bytes], limit: int = 4000) -> list[str]:
    """Return the words of the seeds, for changes that put one in another's place."""
    found: dict[str, None] = {}
    for seed in seeds:
        text = seed.decode("utf-8", "replace")
        found.update(dict.fromkeys(re.findall(r"[\w./:$-]{2,40}|\$\([^()\n]{1,40}\)", text)))
    return list(found)[:limit]
