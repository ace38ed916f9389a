"""What a partner reads is something else now: another type, another message, or a message with other fields."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping

from archgen.compare.losses.both import Both, Loss, several, tick
from archgen.compare.names import Names
from archgen.model.architecture import Architecture
from archgen.model.interfaces import Interface

_INSIDE = ("request", "response", "feedback")


def retyped(both: Both) -> Iterator[Loss]:
    """Find outputs that another partner reads and that have another conceptual type or message."""
    old, new = _messages(both.before, both.names), _messages(both.after, Names())
    for output, readers in sorted(both.told.old.readers.items()):
        pair = (both.told.before.get(("output", output)), both.told.after.get(("output", output)))
        if pair[0] is None or pair[1] is None:
            continue
        types = [each.values.get("type") for each in pair if each]
        was, now = old.get(output, frozenset()), new.get(output, frozenset())
        places, change = _change(both, output, (types[0], types[1]), (was, now))
        stay = [r for r in readers & both.told.new.readers.get(output, frozenset()) if both.needs(r)]
        lost = _by_partner(both, stay, both.keepers("output", output)) if change else {}
        for partner, inputs in sorted(lost.items()):
            name = both.own("output", output)
            why = f"gives {partner}, who reads `{name}` as {several(inputs)}, {change}"
            yield from both.losses(places, partner, why)


def _change(
    both: Both, output: str, types: tuple[object, object], messages: tuple[frozenset[str], frozenset[str]]
) -> tuple[list[int], str]:
    """Return the indices of changes that retyped an output, and what it gives now; ([], "") if nothing changed."""
    (one, other), (was, now) = types, messages
    if one is not None and one != other:
        same = f" (the message stays {several(now)})" if was and was == now else ""
        what = f"{tick(other) if other else 'no type any more'} instead of {tick(one)}"
        return both.about("output", output, "type"), what + same
    if not was or was == now:
        return [], ""
    nodes = [node for node, port in both.ends[1] if port == output]
    places = [place for node in nodes for place in both.port(node, output, "message")]
    what = f"{several(now) or 'no message any more'} instead of {several(was)}"
    return places or (both.about("type", str(other), "message") if other else []), what


def _messages(found: Architecture, names: Names) -> Mapping[str, frozenset[str]]:
    """Return the messages of each output: those of the nodes that write it, else that of its type."""
    written: dict[str, set[str]] = defaultdict(set)
    for end in found.endpoints:
        if end.use in {"publishes", "serves"} and end.port and end.message:
            written[end.port].add(end.message)
    for output in found.outputs.values():
        message = found.message(output)
        if message and output.id not in written:
            written[output.id].add(message)
    return {
        names.to("output", port): frozenset(names.to("message", one) for one in some) for port, some in written.items()
    }


def redefined(both: Both) -> Iterator[Loss]:
    """Find changed message definitions and inner types, and the partners that are built against them."""
    users = _users(both)
    for place, change in enumerate(both.changes):
        if change.kind not in {"changed", "removed"}:
            continue
        if change.sort == "message":
            name = both.common(change)
            partners = _others(
                [user for message in _holding(both, name) for user in users.get(("message", message), ())]
            )
            for partner in sorted(partners):
                yield from both.losses([place], partner, _built(both, name, partner))
        elif change.sort == "type" and change.key in _INSIDE and change.before is not None:
            partners = _others(users.get(("type", change.element), ()))
            for partner in sorted(partners):
                why = f"changes the {change.key} of {tick(change.element)}, which {partner} uses"
                yield from both.losses([place], partner, why)


def _users(both: Both) -> Mapping[tuple[str, str], list[tuple[bool, str]]]:
    """Return for each message and type of the first version its users: whether they write it, and their partner."""
    found: dict[tuple[str, str], list[tuple[bool, str]]] = defaultdict(list)
    for end in both.before.endpoints:
        node = both.before.nodes[end.node]
        component = both.before.components.get(end.component or "")
        partner = (component.owner if component else None) or node.owner
        if not partner:
            continue
        user = end.use in {"publishes", "serves"}, both.names.to("partner", partner)
        if end.message:
            found["message", both.names.to("message", end.message)].append(user)
        if end.type:
            found["type", both.names.to("type", end.type)].append(user)
    return found


def _others(users: Iterable[tuple[bool, str]]) -> frozenset[str]:
    """Return the partners who are broken: all users but the one who alone writes what is defined, if there is one."""
    every = list(users)
    writers = {partner for writes, partner in every if writes}
    return frozenset(partner for _, partner in every) - (writers if len(writers) == 1 else frozenset())


def _holding(both: Both, name: str) -> list[str]:
    """Return a message of the second version and all that contain it, at any depth."""
    packages = both.after.interfaces.project_packages
    own = [n for n in both.after.interfaces.names if n.partition("/")[0] in packages]
    held: dict[str, list[str]] = defaultdict(list)
    for other in sorted(own):
        definition = both.after.interfaces.definitions.get(other)
        for part in definition.parts if definition else ():
            for field in part:
                held[field.type].append(other)
    found = {name: None}
    # The list grows while it is iterated: a breadth-first search.
    for one in (waiting := [name]):
        for other in held.get(one, ()):
            if other not in found:
                found[other] = None
                waiting.append(other)
    return list(found)


def _built(both: Both, name: str, partner: str) -> str:
    """Describe what is different for a partner that was built against a message definition."""
    old = both.before.interfaces.definitions.get(both.names.back.get("message", {}).get(name, name))
    new = both.after.interfaces.definitions.get(name)
    short = tick(name)
    if new is None or old is None:
        return f"takes the definition of {short} from {partner}, who uses it"
    removed, added, other = _fields(old, new)
    words = [f"removes {several(removed)}"] if removed else []
    words += [f"changes the type of {several(other)}"] if other else []
    words += [f"adds {several(added)}"] if added else []
    what = " and ".join(words) or "puts fields in another order"
    # The wire format of ROS has no optional fields; ROS 1 compares checksums and ROS 2 type hashes
    # (docs/decisions/0007-breaking-changes.md).
    only = "even a field more makes another message to ROS: " if added and not (removed or other) else ""
    return f"{what} in {short}, which {partner} uses; {only}what was built before cannot talk to what is built after"


def _fields(old: Interface, new: Interface) -> tuple[set[str], set[str], set[str]]:
    """Return the names of the removed, added and changed fields."""
    one = {(n, f.name): f for n, part in enumerate(old.parts) for f in part}
    two = {(n, f.name): f for n, part in enumerate(new.parts) for f in part}
    changed = {name for (n, name), f in one.items() if (n, name) in two and f != two[n, name]}
    return {name for _, name in one.keys() - two.keys()}, {name for _, name in two.keys() - one.keys()}, changed


def _by_partner(both: Both, readers: Iterable[str], keepers: frozenset[str]) -> Mapping[str, list[str]]:
    found: dict[str, list[str]] = defaultdict(list)
    for reader in readers:
        partner = both.owner("input", reader)
        if partner and partner not in keepers:
            found[partner].append(reader)
    return found
