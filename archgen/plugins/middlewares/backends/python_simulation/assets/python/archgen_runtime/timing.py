"""When components are active."""

import dataclasses


@dataclasses.dataclass(frozen=True)
class Timing:
    """When a component is active, with times in nanoseconds.

    `mode` is `periodic`, `once`, `any`, `all`, `match` or `never`.
    """

    mode: str
    period_ns: int = 0
    triggers: frozenset = frozenset()
    within_ns: int = 0
    every: int = 1
    throttle_ns: int = 0
    keeps_dropped: bool = True


class Activation:
    """Decides which values make a component active."""

    def __init__(self, timing, inputs):
        """Take when the component is active, and its inputs."""
        self._timing = timing
        self._triggers = [each for each in inputs if each.name in timing.triggers]
        self._sets = 0
        self._last_ns = None

    def accept(self, port, value, time_ns):
        """Take a value that arrives; return whether the component is active now."""
        if port not in self._triggers:
            port.store(value, time_ns)
            return False
        is_complete = self._completes(port, time_ns)
        is_taken = not is_complete or self._passes(time_ns)
        if is_taken or self._timing.keeps_dropped:
            port.store(value, time_ns)
        else:
            port.stamp(time_ns)
        if is_complete:
            for each in self._triggers:
                each.is_awaited = True
        return is_complete and is_taken

    def _completes(self, port, time_ns):
        if self._timing.mode == "match":
            # What arrived too long ago is given up: its input waits for another value.
            for each in self._triggers:
                if each is not port and time_ns - each.arrival_ns > self._timing.within_ns:
                    each.is_awaited = True
        if self._timing.mode in {"all", "match"}:
            return not any(each.is_awaited for each in self._triggers if each is not port)
        return self._timing.mode == "any"

    def _passes(self, time_ns):
        self._sets += 1
        is_early = self._last_ns is not None and time_ns - self._last_ns < self._timing.throttle_ns
        if self._sets % self._timing.every or is_early:
            return False
        self._last_ns = time_ns
        return True
