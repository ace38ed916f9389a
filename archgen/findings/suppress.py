"""Comments that silence findings: `# archgen: ignore[unread-output] why`."""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, Protocol

from archgen.diagnostic import Diagnostic, Rule, Severity
from archgen.suggest import did_you_mean

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from archgen.model.architecture import Architecture
    from archgen.source import Span


class Ignore(Protocol):
    """A comment `# archgen: ignore[rule, other] why`. A protocol: the comments themselves come from the syntax."""

    @property
    def rules(self) -> tuple[str, ...]:
        """The names between the brackets."""

    @property
    def why(self) -> str:
        """What follows the brackets."""

    @property
    def at(self) -> Span:
        """The comment's span."""


Lines = frozenset[tuple[str, int]]

UNUSED_IGNORE = Rule(
    "unused-ignore",
    Severity.WARNING,
    """\
A comment says to ignore a finding that is not there.

Why: The fault was mended and the comment forgotten, or the comment stands in the wrong line. It stands at the end of the line
that the finding points at, or of the first line of its element. It would hide the next finding of this kind. Rules about
reading and linking cannot be ignored.

Bad:
    groups:
      sensing:
        components:
          camera: {outputs: {image: sensor_msgs/msg/Image}}  # archgen: ignore[unread-output] the screen comes later
          screen: {inputs: {image: camera.image}}
    nodes:
      camera: {implements: camera}
      screen: {implements: screen}

Good:
    groups:
      sensing:
        components:
          camera:
            outputs:
              image: sensor_msgs/msg/Image
              depth: sensor_msgs/msg/Image  # archgen: ignore[unread-output] the picking arm comes next year
          screen: {inputs: {image: camera.image}}
    nodes:
      camera: {implements: camera}
      screen: {implements: screen}
""",
)


def suppress(
    diagnostics: Iterable[Diagnostic],
    ignores: Iterable[Ignore],
    rules: Mapping[str, Rule],
    first_lines: Mapping[str, Lines],
) -> Iterator[Diagnostic]:
    """Leave out what comments silence, and add what is wrong with the comments.

    This runs before findings are settled, so that a comment for a rule that is switched off counts as used. After read
    or link errors nobody knows what else would have been found: then no comment is called unused.
    """
    ignores = tuple(ignores)
    here: dict[tuple[str, str, int], list[Ignore]] = defaultdict(list)
    for ignore in ignores:
        for name in ignore.rules:
            here[name, ignore.at.file, ignore.at.line].append(ignore)
    used: set[tuple[Span, str]] = set()
    broken = False
    # One pass: it yields what is left, and notes which comments silenced something.
    for diagnostic in diagnostics:
        rule = rules[diagnostic.rule]
        broken = broken or (rule.fixed and (diagnostic.severity or rule.severity) is Severity.ERROR)
        # A comment counts at the line of the finding, and at the first line of its element.
        lines = {(diagnostic.span.file, diagnostic.span.line), *first_lines.get(diagnostic.element or "", ())}
        found = (
            [i for file, line in lines for i in here.get((diagnostic.rule, file, line), ())] if not rule.fixed else []
        )
        used.update((ignore.at, diagnostic.rule) for ignore in found)
        # A fixed rule is never silenced, and its comment is reported below.
        if not found:
            yield diagnostic
    for ignore in ignores:
        if not ignore.rules:
            cure = "name the rule in brackets: `# archgen: ignore[unread-output] why`"
            yield Diagnostic("unused-ignore", "this comment names no rule", ignore.at, help=cure)
        # Every finding has passed by now: only here is it known which comments were used.
        for name in dict.fromkeys(ignore.rules):
            yield from _judge(ignore, name, rules, used=broken or (ignore.at, name) in used)


def _judge(ignore: Ignore, name: str, rules: Mapping[str, Rule], *, used: bool) -> Iterator[Diagnostic]:
    rule = rules.get(name)
    if rule is None:
        cure = did_you_mean(name, (r.name for r in rules.values() if not r.fixed))
        yield Diagnostic("unknown-rule", f"there is no rule `{name}` to ignore", ignore.at, help=cure)
    elif rule.fixed:
        message = f"`{name}` cannot be ignored: what comes after reading and linking rests on it"
        yield Diagnostic("unused-ignore", message, ignore.at, help="mend what it reports, and take the comment out")
    elif not used:
        message = f"nothing here is `{name}`"
        cure = "take it out, or put it at the end of the line that the finding points at"
        yield Diagnostic("unused-ignore", message, ignore.at, help=cure)


def first_lines(architecture: Architecture) -> Mapping[str, Lines]:
    """Return the lines where each element begins, by the id that findings name; elements of several kinds may share one
    id.
    """
    a = architecture
    found: dict[str, set[tuple[str, int]]] = defaultdict(set)
    everything = (
        *(a.partners, a.use_cases, a.requirements, a.groups, a.components, a.inputs, a.outputs, a.types, a.nodes),
        *(a.hosts, a.containers, a.links, a.chains, a.views, a.policies),
    )
    for elements in everything:
        for key, element in elements.items():
            found[key].add((element.at.file, element.at.line))
    # A type that nobody declared has the lines of its ports: in `image: {type: Image}` its own may be another one.
    typed = [(port.type, port.at) for port in a.inputs.values()] + [(port.type, port.at) for port in a.outputs.values()]
    for name, at in typed:
        if name is not None:
            found[name].add((at.file, at.line))
    return {key: frozenset(lines) for key, lines in found.items()}
