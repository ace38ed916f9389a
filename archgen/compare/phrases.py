"""The wording of a changed key."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence

from archgen.compare.change import Change

_LONGEST = 80
_PROSE = frozenset({"functionality", "description", "comment", "text", "external"})
_FLAT = {
    "owner": "belongs to",
    "host": "runs on",
    "container": "runs in the container",
    "message": "is",
    "deadline": "must end within",
    "role": "is a",
    "status": "is",
    "version": "is version",
}
"""Keys with a verb of their own: `x` VERB new value instead of old value."""
_NAMES = {
    "timing.rate": "rate",
    "timing.wcet": "worst case execution time",
    "timing.bcet": "best case execution time",
    "timing.response": "stated response time",
    "use_cases": "use cases",
    "co_owners": "further owners",
    "latency.best": "best latency",
    "latency.worst": "worst latency",
    "forbid.from": "forbidden source",
    "forbid.to": "forbidden target",
    "show": "selector",
    "shared_topics": "shared topics",
    "distro": "ROS distribution",
    "parameter_files": "parameter files",
    "execution_time": "execution time",
}
_VERBS = {
    "implements": ("now implements", "no longer implements"),
    "requirements": ("now serves", "no longer serves"),
    "tags": ("now has the tag", "no longer has the tag"),
    "connects": ("now connects", "no longer connects"),
    "through": ("now leads through", "no longer leads through"),
    "use_cases": ("now belongs to", "no longer belongs to"),
    "kind": ("is now", "is no longer"),
}
"""List keys, with what the element does with added and with removed items."""
_PATHS = frozenset({"component", "input", "output", "connection", "port"})
"""Kinds whose ids are paths that need no kind in front of them."""
_SORTS = {"use_case": "use case", "message": "message", "port": "port"}


def changed_key(change: Change) -> str:
    """Describe how the value of a key changed."""
    key, before, after = change.key or "", change.before, change.after
    name = f"`{short(change.element)}`"
    said = name if "." in change.element and change.sort in _PATHS else f"{_SORTS.get(change.sort, change.sort)} {name}"
    if change.sort == "project":
        said = "the project"
    if key == "qos" and isinstance(before, Mapping) and isinstance(after, Mapping):
        return f"{said}: QoS {listed([f'{_blank(k)} {shown(before[k])} → {shown(after[k])}' for k in before])}"
    if key in _PROSE and (key == "text" or not (_brief(before) and _brief(after))):
        return f"the {_blank(key)} of {said} {_rewritten(before, after)}"
    if change.sort in {"input", "output"} and key in {"type", "optional"}:
        return f"{said} {_of_port(change)}"
    if key in _FLAT and _tellable(key, before, after):
        return f"{said} {_flat(key, before, after)}"
    if key == "topic" and (".serves." in change.element or ".calls." in change.element):
        # What is called a topic in the files is the name of a service or action here.
        key = "name"
    if isinstance(before, list) or isinstance(after, list):
        return f"{said}{_sets(key, before, after)}"
    return f"{said}: {_values(_name(key), before, after)}"


def _tellable(key: str, before: object, after: object) -> bool:
    return key == "container" or (before is not None and after is not None)


def _flat(key: str, before: object, after: object) -> str:
    if after is None:
        return f"no longer {_FLAT[key]} {shown(before)}"
    return f"now {_FLAT[key]} {_instead(before, after, '')}"


def _of_port(change: Change) -> str:
    if change.key == "optional":
        return "is optional now" if change.after else "is no longer optional"
    verb = "carries" if change.sort == "output" else "expects"
    return f"now {verb} {_instead(change.before, change.after, 'nothing named')}"


def _name(key: str) -> str:
    if key.startswith("rules."):
        return f"severity of the rule `{key.removeprefix('rules.')}`"
    if key.startswith("parameters."):
        return f"parameter `{short(key.removeprefix('parameters.'))}`"
    return _NAMES.get(key) or _blank(key.removeprefix("timing.").replace(".", " "))


def _blank(key: str) -> str:
    return short(key).replace("_", " ")


def _values(name: str, before: object, after: object) -> str:
    if before is None:
        return f"{name} set to {shown(after)}"
    if after is None:
        return f"{name} no longer given (it was {shown(before)})"
    return f"{name} {shown(before)} → {shown(after)}"


def _instead(before: object, after: object, nothing: str) -> str:
    if after is None:
        return f"{nothing} instead of {shown(before)}"
    return shown(after) if before is None else f"{shown(after)} instead of {shown(before)}"


def _brief(text: object) -> bool:
    return isinstance(text, str) and len(text) <= _LONGEST and "\n" not in text


def _rewritten(before: object, after: object) -> str:
    # Lines are counted, not quoted: a sentence must stay on one line.
    if isinstance(before, str) and isinstance(after, str) and "\n" in before + after:
        old, new = Counter(before.splitlines()), Counter(after.splitlines())
        counts = ((new - old).total(), "added"), ((old - new).total(), "removed")
        words = [f"{n} line{'s' if n > 1 else ''} {verb}" for n, verb in counts if n]
        return f"changed: {' and '.join(words)}" if words else "has its lines in another order"
    if before is None:
        return "is new"
    return "is gone" if after is None else "is rewritten"


def _sets(key: str, before: object, after: object) -> str:
    """Describe what a list gained and lost, with the key's own verbs if it has any."""
    old = before if isinstance(before, list) else []
    new = after if isinstance(after, list) else []
    name = f": {_name(key)}"
    if len(old) == len(new) == 1:
        return f"{name} {shown(old[0])} → {shown(new[0])}"
    gained = [shown(item) for item in new if item not in old]
    lost = [shown(item) for item in old if item not in new]
    if not gained and not lost:
        return f"{name} are now {listed([shown(item) for item in new])}, in this order"
    if key in _VERBS:
        words = [
            f" {verb} {listed(_few(items))}" for verb, items in zip(_VERBS[key], (gained, lost), strict=True) if items
        ]
        return " and".join(words)
    words = [f" {listed(_few(items))} {verb}" for verb, items in (("added", gained), ("removed", lost)) if items]
    return name + ",".join(words)


def _few(items: Sequence[str]) -> list[str]:
    most = 6
    return [*items] if len(items) <= most else [*items[:most], f"{len(items) - most} more"]


def shown(value: object) -> str:
    """Format a value for a sentence."""
    if value is None:
        return "unlimited"
    if isinstance(value, (bool, int, float)):
        return str(value).lower()
    if isinstance(value, list):
        return listed([shown(item) for item in value]) or "none"
    return f"`{short(str(value))}`"


def short(text: str) -> str:
    """Return a text on one line, at most 80 characters long, without backticks."""
    # A backtick inside would end the code span that sentences put the text into, and let a name pose as our own words.
    line = " ".join(text.replace("`", "'").split())
    return line if len(line) <= _LONGEST else f"{line[: _LONGEST - 1]}…"


def listed(items: Sequence[str]) -> str:
    """Join items as a sentence does: "a, b and c"."""
    return " and ".join((", ".join(items[:-1]), items[-1])) if len(items) > 1 else "".join(items)
