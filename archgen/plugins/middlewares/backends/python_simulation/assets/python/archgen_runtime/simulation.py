"""A run of an architecture in logical time."""

import heapq
from collections import deque
from functools import partial

from .errors import SimulationError
from .values import read_value, write_value

_MOST_STEPS = 100_000
_DEEPEST_CALL = 100
_SCENARIO, _CLOCK = 0, 1


class Simulation:
    """A run. What takes part in it takes part in no other."""

    def __init__(self, assembly, trace):
        """Take what is run, and a file that gets a line for each value that is sent or arrives."""
        self.now_ns = 0
        self._trace = trace
        self._agenda = []
        self._steps = deque()
        self._given_count = 0
        self._call_depth = 0
        self._inputs = {}
        self._outputs = {}
        assembly.sort_readers()
        for order, component in enumerate(assembly.components):
            component.join(self)
            self._inputs.update((port.id, port) for port in component.inputs)
            self._outputs.update((port.id, port) for port in component.outputs)
            if component.timing.mode == "once":
                activate = partial(self._activate, component)
                heapq.heappush(self._agenda, (0, _CLOCK, order, activate))
            elif component.timing.mode == "periodic":
                self._add_timer(component, 0, order)

    def _add_timer(self, component, time_ns, order):
        def work():
            self._add_timer(component, time_ns + component.timing.period_ns, order)
            self._activate(component)

        heapq.heappush(self._agenda, (time_ns, _CLOCK, order, work))

    def arrive(self, time_ns, input_id, value):
        """Let a value arrive at an input at a time; it is JSON."""
        port = self._inputs.get(input_id)
        if port is None:
            raise SimulationError(f"there is no input {input_id}")
        read = read_value(value, port.kind)
        self._give(time_ns, lambda: self._deliver(port, read))

    def emit(self, time_ns, output_id, value):
        """Let an output send a value, as if its component did; it is JSON."""
        port = self._outputs.get(output_id)
        if port is None:
            raise SimulationError(f"there is no output {output_id}")
        read = read_value(value, port.kind)
        self._give(time_ns, lambda: self.send(port, read))

    def _give(self, time_ns, work):
        if time_ns < self.now_ns:
            raise SimulationError(f"it is {self.now_ns} ns already")
        heapq.heappush(self._agenda, (time_ns, _SCENARIO, self._given_count, work))
        self._given_count += 1

    def run(self, end_ns):
        """Run all that happens before a time."""
        while self._agenda and self._agenda[0][0] < end_ns:
            self.now_ns = self._agenda[0][0]
            while self._agenda and self._agenda[0][0] == self.now_ns:
                self._steps.append(heapq.heappop(self._agenda)[3])
            self._run_instant()
        self.now_ns = max(self.now_ns, end_ns)

    def _run_instant(self):
        count = 0
        while self._steps:
            count += 1
            if count > _MOST_STEPS:
                raise SimulationError(f"at {self.now_ns} ns messages go round without end")
            self._steps.popleft()()

    def send(self, port, value):
        """Send a value from an output."""
        value = port.kind.check(value, f"what {port.id} sends")
        self._write(">", port, value)
        for reader in port.readers:
            self._steps.append(lambda each=reader: self._deliver(each, value))

    def call(self, client, server, request, feedback):
        """Return the answer of a server."""
        if self._call_depth >= _DEEPEST_CALL:
            raise SimulationError(f"at {self.now_ns} ns calls of {client.id} go round without end")

        def tell(told):
            self._write("~", client, told)
            if feedback is not None:
                feedback(told)

        self._write("?", client, request)
        self._call_depth += 1
        answer = server.answer(request, tell)
        self._call_depth -= 1
        self._write("!", client, answer)
        return answer

    def _deliver(self, port, value):
        self._write("<", port, value)
        if port.component.activation.accept(port, value, self.now_ns):
            self._activate(port.component)

    def _activate(self, component):
        try:
            component.fire()
        except SimulationError:
            raise
        except Exception as error:
            raise SimulationError(f"at {self.now_ns} ns in {component.id}: {error!r}") from error
        for port in component.inputs:
            port.clear_fresh()

    def _write(self, mark, port, value):
        self._trace.write(f"{self.now_ns} {mark} {port.id} {write_value(value)}\n")
