"""Hosts as a rack: a strip for each with its cores and heaviest nodes, the links beside them, and what crosses each link."""

from __future__ import annotations

import math
import textwrap
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from decimal import ROUND_CEILING
from fractions import Fraction

from archgen.frozen import dataclass, replace
from archgen.model.deployment import Host, Link
from archgen.model.node import Node
from archgen.model.runtime_facts import find_container_threads
from archgen.timing.analysis import HostLoad
from archgen.timing.figures.timing_values import TimingValue
from archgen.views.inline_text import count_noun, cut_text
from archgen.views.lookup import Lookup
from archgen.views.picture_shapes import UPRIGHT, Sheet, SheetBar, SheetColour, SheetLine, SheetText

_STRIP_GAP = 8.0
_BARE_HEIGHT, _ROW_HEIGHT = 46.0, 15.0
"""Of a strip without rows of nodes and flows, and of such a row."""
_SLIDE_HEIGHT = 430.0
"""A rack of so high strips, its link and its note fill a slide in the height as they do in the width."""
_TITLE_WIDTH, _CORES_WIDTH, _NODES_WIDTH = 214.0, 165.0, 190.0
_CORE_WIDTH, _MOST_CORES = 16.5, 32
_UPRIGHT_WIDTH = 440.0
_LINK_STEP, _LINK_WIDTH, _STUB = 20.0, 13.0, 22.0
_TRAFFIC_WIDTH = 150.0
_BYTE_UNITS = ((10**9, "GB"), (10**6, "MB"), (10**3, "kB"))
_SMALL_CHARACTER = 4.4
"""How wide a character of the smallest writing is."""
_FEW_HOSTS = 6
"""Up to here a strip has room for more rows."""
_VERDICTS: Mapping[str, tuple[str, SheetColour]] = {
    "schedulable": ("all in time", "green"),
    "overload": ("overloaded", "red"),
    "undecided": ("in time: not proven", "amber"),
    "unknown": ("in time: not known", "amber"),
}


@dataclass(frozen=True, slots=True)
class _Crossing:
    """What crosses links between two hosts on a topic, in B/s."""

    link: str
    giver: str
    taker: str
    topic: str
    traffic: TimingValue


def draw_host_racks(lookup: Lookup) -> tuple[Sheet, ...]:
    """Draw the hosts for screens and slides, and for paper and narrow screens; nothing without a host."""
    if not lookup.architecture.hosts:
        return ()
    return _draw_rack(lookup, 4 if len(lookup.architecture.hosts) <= _FEW_HOSTS else 2), _draw_upright(lookup)


def draw_slide_rack(lookup: Lookup) -> Sheet:
    """Draw the hosts for a slide: of each as much as leaves the type of all as large as it can be."""
    room = _SLIDE_HEIGHT / max(1, len(lookup.architecture.hosts)) - _STRIP_GAP - _BARE_HEIGHT
    sheet = _draw_rack(lookup, max(1, min(4, int(room / _ROW_HEIGHT))))
    return replace(sheet, id="hosts_slide", notes=sheet.notes[:1])


def list_crossings(lookup: Lookup) -> tuple[_Crossing, ...]:
    """Return what crosses links from one host to another, summed by topic, the heaviest first, what is unknown last."""
    if lookup.timing is None:
        return ()
    from archgen.timing.figures.timing_values import add_values
    from archgen.timing.rates.link_traffic import measure_arc_traffic

    analysis = lookup.timing.analysis
    parts: dict[tuple[str, str, str, str], list[TimingValue]] = defaultdict(list)
    for arc in analysis.system.arcs:
        ends = [_host_of(lookup, analysis.system.activities[end].node) for end in (arc.source, arc.target)]
        if arc.link is not None and all(ends):
            parts[arc.link, str(ends[0]), str(ends[1]), arc.topic].append(measure_arc_traffic(analysis, arc))
    crossings = [_Crossing(*key, add_values(values)) for key, values in parts.items()]
    return tuple(sorted(crossings, key=lambda each: (each.traffic.value is None, -(each.traffic.value or 0))))


def _host_of(lookup: Lookup, node_id: str) -> str | None:
    node = lookup.architecture.nodes.get(node_id)
    container = lookup.architecture.containers.get(node.container or "") if node else None
    return container.host if container else node.host if node else None


class _Canvas:
    """Collects the parts of a sheet."""

    def __init__(self) -> None:
        self.bars, self.texts, self.lines = list[SheetBar](), list[SheetText](), list[SheetLine]()

    def write(self, x: float, y: float, text: str, characters: int = 200, **look: object) -> None:
        """Write a text, cut at a number of characters."""
        self.texts.append(SheetText(x, y, cut_text(text, characters), **look))  # type: ignore[arg-type]

    def finish(self, lookup: Lookup, name: str, crossings: Sequence[_Crossing]) -> Sheet:
        """Return the sheet, with what is to be known of its figures."""
        architecture = lookup.architecture
        notes = ["A cell is a core, filled by what is pinned to it; pale ones share the rest. Figures are rounded up."]
        notes[0] += " Hatched is what nobody knows." if any(bar.fill == "unknown" for bar in self.bars) else ""
        notes += ["■ runs in a container, a process of several nodes."] if architecture.containers else []
        if crossings:
            notes.append(
                "Bytes are counted once for each reader on another host, from the sizes and rates that are written."
            )
        return Sheet(
            name,
            f"{architecture.project.title}: hosts and what crosses their links",
            tuple(self.bars),
            tuple(self.texts),
            tuple(self.lines),
            notes=tuple(notes),
            alt=f"{count_noun(len(architecture.hosts), 'host')} with "
            f"{count_noun(len(architecture.containers), 'container')} and {count_noun(len(architecture.links), 'link')}: "
            f"{', '.join(host.title for host in architecture.hosts.values())}.",
        )


def _draw_rack(lookup: Lookup, rows: int) -> Sheet:
    canvas, crossings = _Canvas(), list_crossings(lookup)
    hosts = list(lookup.architecture.hosts.values())
    height = _BARE_HEIGHT + rows * _ROW_HEIGHT
    width = _TITLE_WIDTH + _CORES_WIDTH + _NODES_WIDTH + 36
    links = [
        link
        for link in lookup.architecture.links.values()
        if any(end in lookup.architecture.hosts for end in link.connects)
    ]
    link_lefts = {link.id: width + _STUB + at * _LINK_STEP for at, link in enumerate(links)}
    middles: dict[str, float] = {}
    for at, host in enumerate(hosts):
        top = at * (height + _STRIP_GAP)
        middles[host.id] = top + height / 2
        canvas.bars.append(SheetBar(0, top, width, height, "paper", "line", rounded=True))
        _write_heading(lookup, canvas, host, 12, top, height)
        _draw_cores(lookup, canvas, host, _TITLE_WIDTH + 12, top, height)
        _draw_nodes(lookup, canvas, host, _TITLE_WIDTH + _CORES_WIDTH + 24, top, rows, height)
        if links:
            _write_traffic(lookup, canvas, crossings, host, width + _STUB + len(links) * _LINK_STEP + 8, top, rows)
    bottom = len(hosts) * (height + _STRIP_GAP) - _STRIP_GAP
    for at, link in enumerate(links):
        _draw_link(lookup, canvas, link, link_lefts[link.id], bottom, -10.0 - 13 * (len(links) - 1 - at))
        for end in dict.fromkeys(link.connects):
            if end in middles:
                _draw_stubs(
                    canvas,
                    crossings,
                    link,
                    end,
                    width,
                    link_lefts[link.id],
                    middles[end] + (at - (len(links) - 1) / 2) * 16,
                )
    _write_homeless(lookup, canvas, bottom)
    return canvas.finish(lookup, "hosts", crossings)


def _draw_upright(lookup: Lookup) -> Sheet:
    """Draw the same as wide as a page of paper: what crosses links stands in each strip, below its cores."""
    canvas, crossings = _Canvas(), list_crossings(lookup)
    top = 0.0
    for link in lookup.architecture.links.values():
        canvas.write(0, top + 6, _describe_link(lookup, link), 90, bold=True, ink="blue", ref=f"link:{link.id}")
        top += 14
    for host in lookup.architecture.hosts.values():
        own = [each for each in crossings if host.id in {each.giver, each.taker}]
        height = 92.0 + (27 if own else 0)
        canvas.bars.append(SheetBar(0, top, _UPRIGHT_WIDTH, height, "paper", "line", rounded=True))
        _write_heading(lookup, canvas, host, 10, top, 92, 26)
        _draw_cores(lookup, canvas, host, 160, top, 92, 110)
        _draw_nodes(lookup, canvas, host, 282, top, 3, 92, 148)
        for at, (word, colour) in enumerate((("sends", "blue"), ("takes", "amber")) if own else ()):
            flows = [each for each in own if (each.giver if word == "sends" else each.taker) == host.id]
            names = ", ".join(_name_flow(lookup, each, host.id, 18) for each in flows[:2])
            ink: SheetColour = "blue" if colour == "blue" else "amber"
            y = top + 96 + at * 12
            canvas.write(10, y, f"{word} {_sum_traffic(flows)}", 24, size=8, bold=True, ink=ink)
            more = f", {len(flows) - 2} more" if len(flows) > 2 else ""  # noqa: PLR2004 - two are named
            canvas.write(110, y, names + more, 76, size=8, ink="muted")
        top += height + _STRIP_GAP
    _write_homeless(lookup, canvas, top - _STRIP_GAP)
    return canvas.finish(lookup, f"hosts{UPRIGHT}", crossings)


def _load_of(lookup: Lookup, host: Host) -> HostLoad | None:
    load = lookup.timing.analysis.hosts.get(host.id) if lookup.timing else None
    return load if load is not None and load.activity_shares and load.cores is not None else None


def _write_heading(  # noqa: PLR0913, PLR0917 - a host and its place
    lookup: Lookup, canvas: _Canvas, host: Host, x: float, top: float, height: float, characters: int = 36
) -> None:
    nodes = _list_nodes(lookup, host)
    # A strip of two rows and more has room for a second line.
    most = 2 if height > _BARE_HEIGHT + 2 * _ROW_HEIGHT else 1
    lines = textwrap.wrap(host.title, characters, max_lines=most, placeholder="…") or [""]
    for at, line in enumerate(lines):
        y = top + 14 + 12 * at
        canvas.write(x, y, line, characters, size=10.5, bold=True, ref=f"host:{host.id}", tooltip=host.title)
    below = top + 12 * (len(lines) - 1)
    cores = [count_noun(host.cores, "core")] if host.cores is not None else []
    canvas.write(x, below + 28, " · ".join([*cores, count_noun(len(nodes), "node")]), ink="muted")
    tags = ", ".join(host.tags)
    canvas.write(x, below + 41, tags, characters, size=8, ink="violet")
    load = _load_of(lookup, host)
    y = top + height - 22
    if load is None or load.cores is None:
        canvas.write(x, y + 12, "load not known" if nodes else "nothing runs on it", size=8, ink="muted")
        return
    words, colour = _VERDICTS[load.verdict]
    canvas.write(x + 132, y - 7, words, size=8, bold=True, side="right", ink=colour)
    share = TimingValue(
        None if load.utilisation.value is None else load.utilisation.value / load.cores,
        load.utilisation.complete,
        side=load.utilisation.side,
    )
    canvas.bars.append(SheetBar(x, y, 132, 6, "unknown" if not share.complete else "blank", rounded=share.complete))
    if share.value:
        used = 132 * min(1.0, float(share.value))
        canvas.bars.append(SheetBar(x, y, used, 6, "red" if share.value > 1 else "blue"))
    canvas.write(x, y + 13, f"{_percent(share)} of all cores", size=8.5, bold=True)


def _list_nodes(lookup: Lookup, host: Host) -> list[Node]:
    return [node for node in lookup.architecture.nodes.values() if _host_of(lookup, node.id) == host.id]


def _percent(share: TimingValue) -> str:
    """Write a share in per cent, rounded up, with the sign of its side; what is known of a sum with gaps is a least."""
    if share.value is None or (not share.value and not share.complete):
        return "? %"
    sign = {"at most": "<= ", "at least": ">= ", "exact": ""}[share.side] if share.complete else ">= "
    return f"{sign}{_round_up(share.value * 100)} %"


def _round_up(value: Fraction, decimals: int = 1) -> str:
    from archgen.views.timing.value_format import display_number

    return display_number(value, decimals, ROUND_CEILING)


def _sort_core_loads(load: HostLoad | None) -> tuple[dict[int, TimingValue], tuple[int, TimingValue] | None]:
    """Return the loads of pinned cores by number, and how many others share what load."""
    pinned: dict[int, TimingValue] = {}
    shared = None
    for place, cores, core_load in load.core_loads if load else ():
        number = place.rpartition(" ")[2]
        if " " in place and number.isdecimal():
            pinned[int(number)] = core_load
        else:
            shared = (cores, core_load)
    return pinned, shared


def _draw_cores(  # noqa: PLR0913, PLR0917 - a host and its place
    lookup: Lookup, canvas: _Canvas, host: Host, x: float, top: float, height: float, width: float = _CORES_WIDTH
) -> None:
    """Draw a cell for each core: what is pinned fills its own, what shares the others fills them to one level."""
    load, count = _load_of(lookup, host), host.cores or 0
    if not count:
        return
    canvas.write(x, top + 10, "cores, % of each", size=8, ink="muted")
    if count > _MOST_CORES:
        canvas.write(x, top + 24, f"{count} cores", size=8, ink="muted")
        return
    step = min(_CORE_WIDTH, width / count)
    y, tall = top + 29, height - 44
    pinned, shared = _sort_core_loads(load)
    free = [at for at in range(count) if at not in pinned]
    for at in range(count):
        left = x + at * step
        core_share = pinned.get(at)
        canvas.bars.append(SheetBar(left, y, step - 2, tall, "tint" if at not in pinned else "paper", "blank"))
        if core_share is not None and core_share.value:
            full = min(1.0, float(core_share.value))
            colour: SheetColour = "red" if core_share.value > 1 else "blue"
            canvas.bars.append(SheetBar(left, y + tall * (1 - full), step - 2, tall * full, colour))
        if core_share is not None and step > 11:  # noqa: PLR2004 - three digits
            words = str(math.ceil(core_share.value * 100)) if core_share.value is not None else "?"
            canvas.write(left + step / 2 - 1, y - 5, words, size=8, bold=True, side="middle")
        if step > 8 or at % 4 == 0:  # noqa: PLR2004 - two digits
            canvas.write(left + step / 2 - 1, y + tall + 6, str(at), size=7.5, side="middle", ink="muted")
    if shared and free and shared[1].value:
        level = tall * min(1.0, float(shared[1].value / shared[0]))
        for at in free:
            canvas.bars.append(SheetBar(x + at * step, y + tall - level, step - 2, level, "step2"))
        words = f"{math.ceil(shared[1].value * 100)} of {shared[0] * 100}"
        canvas.write(x + (free[0] + free[-1] + 1) * step / 2 - 1, y - 5, words, size=8, bold=True, side="middle")


def _draw_nodes(  # noqa: PLR0913, PLR0917 - a host and its place
    lookup: Lookup,
    canvas: _Canvas,
    host: Host,
    x: float,
    top: float,
    rows: int,
    height: float,
    width: float = _NODES_WIDTH,
) -> None:
    """Write the heaviest nodes with a bar each, how many more there are, and what runs in containers."""
    load = _load_of(lookup, host)
    nodes = {node.id: node for node in _list_nodes(lookup, host)}
    if load is None or lookup.timing is None:
        canvas.write(x, top + 10, "nodes" if nodes else "", size=8, ink="muted")
        for at, name in enumerate([*nodes][:rows]):
            canvas.write(x, top + 24 + at * 14, name, int(width / 5))
        if len(nodes) > rows:
            canvas.write(x, top + 24 + rows * 14, f"{len(nodes) - rows} more", size=8, ink="muted")
        return
    from archgen.views.timing.host_waterfall import sum_by_node

    shares = sum_by_node(lookup.timing, load, 1)
    canvas.write(x, top + 10, "heaviest, % of one core", size=8, ink="muted")
    shown = [*shares.items()][:rows]
    most = max((float(share.value or 0) for _, share in shown), default=0.0) or 1.0
    text_width = width * 0.6
    for at, (name, share) in enumerate(shown):
        y = top + 24 + at * 14
        node = nodes.get(name)
        sign = " ■" if node and node.container in lookup.architecture.containers else ""
        canvas.write(x, y, name[: int(text_width / 5)] + sign, int(text_width / 4.6), ref=f"node:{name}", tooltip=name)
        bar = (width - text_width - 28) * float(share.value or 0) / most
        if not share.complete:
            canvas.bars.append(
                SheetBar(x + text_width, y - 3.5, 24, 7, "unknown", tooltip=f"of {name} not all is known")
            )
            bar = 24.0
        elif bar:
            canvas.bars.append(SheetBar(x + text_width, y - 3.5, bar, 7))
        canvas.write(x + text_width + bar + 3, y, _percent(share).removesuffix(" %"), size=8, bold=True)
    rest = [share for _, share in shares.items()][rows:]
    if rest:
        total = sum((share.value or Fraction(0) for share in rest), Fraction(0))
        sign = "" if all(share.complete for share in rest) else "at least "
        words = f"{len(rest)} more, together {sign}{_round_up(total * 100)} %"
        canvas.write(x, top + 24 + rows * 14, words, size=8, ink="muted")
    for words in _describe_containers(lookup, host, shares, int(width / _SMALL_CHARACTER)):
        canvas.write(x, top + height - 8, words, size=8, ink="violet")


def _describe_containers(
    lookup: Lookup, host: Host, shares: Mapping[str, TimingValue], characters: int
) -> Iterator[str]:
    """Yield a line on the heaviest container, with how many others there are: its title is cut, its figures are not."""
    architecture = lookup.architecture
    described = []
    for container in architecture.containers.values():
        if container.host != host.id:
            continue
        members = [node.id for node in architecture.nodes.values() if node.container == container.id]
        total = sum((shares[name].value or Fraction(0) for name in members if name in shares), Fraction(0))
        threads = find_container_threads(architecture, container)
        load = f": {_round_up(total * 100)} %, {count_noun(len(members), 'node')}"
        described.append(
            (total, container.title, f"{load}, {count_noun(threads, 'thread')}" if threads else load, load)
        )
    if described:
        _, title, *forms = max(described, key=lambda each: each[0])
        more = f"; {len(described) - 1} more" if len(described) > 1 else ""
        rooms = [characters - len(f"■ {form}{more}") for form in forms]
        at = 0 if len(title) <= rooms[0] else 1
        yield f"■ {cut_text(title, rooms[at])}{forms[at]}{more}"


def _draw_link(  # noqa: PLR0913, PLR0917 - a link and its place
    lookup: Lookup, canvas: _Canvas, link: Link, left: float, bottom: float, y: float
) -> None:
    words = _describe_link(lookup, link)
    canvas.bars.append(
        SheetBar(left, 0, _LINK_WIDTH, bottom, "tint", "blue", rounded=True, ref=f"link:{link.id}", tooltip=words)
    )
    canvas.write(left + _LINK_WIDTH, y, words, 110, size=9, bold=True, side="right", ink="blue", ref=f"link:{link.id}")


def _describe_link(lookup: Lookup, link: Link) -> str:
    load = lookup.timing.analysis.links.get(link.id) if lookup.timing else None
    traffic = _write_bytes(load.traffic) if load else ""
    times = [quantity.text for quantity in (link.best, link.worst) if quantity]
    parts = [
        link.title,
        link.bandwidth.text if link.bandwidth else "",
        traffic if not traffic.startswith("?") else "",
        f"{_percent(load.share)} of it" if load and load.share.value is not None else "",
        " to ".join(dict.fromkeys(times)) + " a hop" if times else "",
        count_noun(len(link.devices), "device") if link.devices else "",
    ]
    return " · ".join(filter(None, parts))


def _draw_stubs(  # noqa: PLR0913, PLR0917 - a host, its link, and where they meet
    canvas: _Canvas, crossings: Sequence[_Crossing], link: Link, host: str, x: float, link_left: float, y: float
) -> None:
    """Draw an arrow into the link and one out of it, as wide as what they carry."""
    sent = sum(
        (each.traffic.value or 0 for each in crossings if each.link == link.id and each.giver == host), Fraction(0)
    )
    taken = sum(
        (each.traffic.value or 0 for each in crossings if each.link == link.id and each.taker == host), Fraction(0)
    )
    for amount, shift, is_out in ((sent, -4, True), (taken, 5, False)):
        if amount:
            ends = ((x, y + shift), (link_left, y + shift))
            ink: SheetColour = "blue" if is_out else "amber"
            canvas.lines.append(SheetLine(ends if is_out else ends[::-1], _choose_width(amount), ink))
    if not sent and not taken:
        canvas.lines.append(SheetLine(((x, y), (link_left, y)), 1.0, head=False))


def _choose_width(amount: Fraction | int) -> float:
    """Return the width of an arrow by bytes per second: 1 up to 10 kB/s, a step for each tenfold."""
    return next(
        (width for least, width in ((10**7, 6.0), (10**6, 4.5), (10**5, 3.0), (10**4, 2.0)) if amount >= least), 1.0
    )


def _write_traffic(  # noqa: PLR0913, PLR0917 - a host and its place
    lookup: Lookup, canvas: _Canvas, crossings: Sequence[_Crossing], host: Host, x: float, top: float, rows: int
) -> None:
    for column, (word, ink) in enumerate((("sends", "blue"), ("takes", "amber"))):
        flows = [each for each in crossings if (each.giver if word == "sends" else each.taker) == host.id]
        left = x + column * _TRAFFIC_WIDTH
        colour: SheetColour = "blue" if ink == "blue" else "amber"
        canvas.write(left, top + 10, f"{word} {_sum_traffic(flows)}", size=9, bold=True, ink=colour)
        shown = flows[: rows - 1]
        for at, each in enumerate(shown):
            other = lookup.architecture.hosts[each.taker if word == "sends" else each.giver].title
            y = top + 24 + at * 24
            canvas.write(left, y, _shorten_topic(each.topic, 28), ref=f"topic:{each.topic}", tooltip=each.topic)
            way = "to" if word == "sends" else "from"
            canvas.write(
                left, y + 10.5, f"{way} {cut_text(other, 18)}, {_write_bytes(each.traffic)}", size=8, ink="muted"
            )
        if len(flows) > len(shown):
            canvas.write(
                left, top + 24 + len(shown) * 24, count_noun(len(flows) - len(shown), "more flow"), size=8, ink="muted"
            )


def _name_flow(lookup: Lookup, crossing: _Crossing, host: str, characters: int) -> str:
    other = crossing.taker if crossing.giver == host else crossing.giver
    way = "to" if crossing.giver == host else "from"
    title = cut_text(lookup.architecture.hosts[other].title, characters)
    return f"{_shorten_topic(crossing.topic, 22)} {way} {title}"


def _sum_traffic(flows: Sequence[_Crossing]) -> str:
    from archgen.timing.figures.timing_values import add_values

    return _write_bytes(add_values([each.traffic for each in flows])) if flows else "nothing"


def _write_bytes(value: TimingValue) -> str:
    """Write bytes per second with three digits, rounded up."""
    if value.value is None or (not value.value and not value.complete):
        return "? B/s"
    from archgen.views.timing.value_format import bound_sign

    factor, unit = next((each for each in _BYTE_UNITS if value.value >= each[0]), (1, "B"))
    number = value.value / factor
    return f"{bound_sign(value)}{_round_up(number, 0 if number >= 100 else 1 if number >= 10 else 2)} {unit}/s"  # noqa: PLR2004


def _shorten_topic(name: str, characters: int) -> str:
    """Cut a name at its front: its end tells more."""
    return name if len(name) <= characters else f"…{name[1 - characters :]}"


def _write_homeless(lookup: Lookup, canvas: _Canvas, bottom: float) -> None:
    count = sum(_host_of(lookup, node) not in lookup.architecture.hosts for node in lookup.architecture.nodes)
    if count:
        canvas.write(0, bottom + 14, f"{count_noun(count, 'node')} on no host yet", ink="amber", bold=True)
