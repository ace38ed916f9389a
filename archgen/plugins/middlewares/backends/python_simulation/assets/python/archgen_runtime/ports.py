"""Ports of components."""

from .errors import SimulationError


class Port:
    """A port of a component."""

    def __init__(self, component, name):
        """Take the component, and the name in the model."""
        self.component = component
        self.name = name

    @property
    def id(self):
        """The id in the model."""
        return f"{self.component.id}.{self.name}"


class InPort(Port):
    """An input: it holds what arrived."""

    def __init__(self, component, name, kind):
        """Begin without any value."""
        super().__init__(component, name)
        self.kind = kind
        self._fresh = []
        self._latest = None
        self.arrival_ns = 0
        self.is_awaited = True

    def latest(self):
        """Return the newest value; None as long as none arrived."""
        return self._latest

    def fresh(self):
        """Return what arrived since the component was active last, the oldest first."""
        return tuple(self._fresh)

    def is_fresh(self):
        """Return whether something arrived since the component was active last."""
        return bool(self._fresh)

    def store(self, value, time_ns):
        """Keep what arrives."""
        self._fresh.append(value)
        self._latest = value
        self.stamp(time_ns)

    def stamp(self, time_ns):
        """Remember that something arrived, and nothing of it."""
        self.arrival_ns = time_ns
        self.is_awaited = False

    def clear_fresh(self):
        """Take what arrived as seen."""
        self._fresh.clear()


class OutPort(Port):
    """An output: what is sent arrives at its readers in the same instant."""

    def __init__(self, component, name, kind):
        """Begin without readers."""
        super().__init__(component, name)
        self.kind = kind
        self.readers = []

    def send(self, value):
        """Send a value. It arrives when what was sent before has arrived."""
        self.component.simulation.send(self, value)


class Server(Port):
    """What others may call: a service or an action."""

    def __init__(self, component, name, handler):
        """Take what answers: it gets the request, and whom to tell what happens in between."""
        super().__init__(component, name)
        self.answer = handler


class Client(Port):
    """What a component calls: a service or an action. A call takes no time."""

    def __init__(self, component, name):
        """Begin without a server."""
        super().__init__(component, name)
        self.servers = []

    def call(self, request, feedback=None):
        """Call the server, of several the first in the model, and return its answer."""
        if not self.servers:
            raise SimulationError(f"{self.id} is connected to nothing that answers")
        return self.component.simulation.call(self, self.servers[0], request, feedback)
