"""What reading one input may cost: every step of an interpreter, and all that it makes, is paid for from one budget."""

from __future__ import annotations

CHARACTERS_IN_A_STEP = 16
STEPS_OF_A_KEPT_VALUE = 8
"""What becomes part of the outcome is written, read again and judged."""
_KEPT_SHARE = 10


class WorkBudget:
    """The steps that are left. One stands for half a microsecond of a machine of 2024, or for fifty bytes that are kept.

    What repeats or grows (loops, calls, sums of lists) gets all but a tenth of them. The lines behind it are each followed
    once, so that what was read until then is still put to use.
    """

    __slots__ = ("_around", "_is_told", "_kept", "_left", "steps")

    def __init__(self, steps: int, around: WorkBudget | None = None) -> None:
        """Give so many steps, of those that are left around: a share for each of several parts of the input."""
        self.steps = self._left = steps
        self._kept = steps // _KEPT_SHARE
        self._around = around
        self._is_told = False

    def halve(self) -> WorkBudget:
        """Return a budget of half of what is left, so that enough stays for what is done with the outcome."""
        return WorkBudget(self.left // 2, self)

    @property
    def left(self) -> int:
        """How many steps there are."""
        return self._left if self._around is None else min(self._left, self._around.left)

    def add(self, steps: int) -> None:
        """Give more steps, for more that is read."""
        self.steps += steps
        self._left += steps
        self._kept = self.steps // _KEPT_SHARE

    def pay(self, steps: int = 1) -> bool:
        """Take steps for what is done once; False, and none are taken, where there are not so many left."""
        if steps > self._left or not (self._around is None or self._around.pay(steps)):
            return False
        self._left -= steps
        return True

    def pay_to_repeat(self, steps: int = 1) -> bool:
        """Take steps for what is done again, or makes something larger; False where it must end."""
        return steps <= self._left - self._kept and self.pay(steps)

    def tell_excess(self) -> str:
        """Return why something is not read, the first time that this is asked; then an empty text: it is told once."""
        words = (
            f"this takes more than the {self.steps:,} steps that archgen follows: what comes later is not read whole"
        )
        words, self._is_told = "" if self._is_told else words, True
        return words
