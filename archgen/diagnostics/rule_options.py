"""Options of rules: thresholds that are a matter of taste, and that a project may set beside a rule's severity."""

from __future__ import annotations

import re
from collections.abc import Mapping
from fractions import Fraction
from typing import TYPE_CHECKING

from archgen.frozen import NamedTuple, dataclass

if TYPE_CHECKING:
    from archgen.diagnostics.source_span import Span

_PERCENT_PATTERN = re.compile(r"([0-9]{1,4}(?:\.[0-9]{1,3})?) ?%\Z", re.ASCII)

OptionValues = Mapping[str, Fraction]
"""The values of a rule's options by name, each as a share: `20 %` is 1/5."""


class WrittenOption(NamedTuple):
    """An option as a project writes it, not judged yet."""

    text: str
    key_span: Span
    value_span: Span


@dataclass(frozen=True, slots=True)
class RuleOption:
    """A threshold of a rule, in percent.

    `default` is what the rule does without it; `least` and `most` are the range, all of them in percent. `summary` is one
    sentence for the rule's page.
    """

    name: str
    default: int
    least: int
    most: int
    summary: str

    @property
    def example(self) -> int:
        """A value in percent, other than the default, that a page can show."""
        return 80 if self.default == 100 else 20  # noqa: PLR2004 - a limit is tightened, a margin is widened

    @property
    def range_phrase(self) -> str:
        """The range in words."""
        return f"from {self.least} % to {self.most} %"

    def parse_value(self, text: str) -> Fraction | None:
        """Return the share that a text such as `20 %` means; None if it is none, or out of the range."""
        share = parse_percentage(text)
        return share if share is not None and self.least <= share * 100 <= self.most else None


def parse_percentage(text: str) -> Fraction | None:
    """Return the share that a text such as `20 %` means; None if it is none."""
    match = _PERCENT_PATTERN.match(text)
    return Fraction(match[1]) / 100 if match else None


def format_percentage(share: Fraction) -> str:
    """Format a share as it is written: `20 %`. Exact, for at most three decimals are read."""
    return f"{float(100 * share):.3f}".rstrip("0").rstrip(".") + " %"


def read_option_values(options: tuple[RuleOption, ...], set_values: OptionValues) -> dict[str, Fraction]:
    """Return the value of every option of a rule: as set, else its default."""
    return {option.name: set_values.get(option.name, Fraction(option.default, 100)) for option in options}
