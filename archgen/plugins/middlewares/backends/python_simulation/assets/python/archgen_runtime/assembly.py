"""What holds components and joins their ports: a group, a composed component, the whole."""

from .ports import Server


class Assembly:
    """An assembly. It begins without parts."""

    def __init__(self):
        """Begin without parts."""
        self.components = []

    def add(self, component):
        """Add a component, and return it."""
        self.components.append(component)
        return component

    def include(self, assembly):
        """Add an assembly with all that it holds, and return it."""
        self.components += assembly.components
        return assembly

    @staticmethod
    def connect(source, reader):
        """Let an input read an output, or a client call a server."""
        if isinstance(source, Server):
            reader.servers.append(source)
        else:
            source.readers.append(reader)

    def list_connections(self):
        """Return `OUTPUT -> INPUT` for each connection, in the order of the outputs."""
        self.sort_readers()
        outputs = [port for component in self.components for port in component.outputs]
        clients = [port for component in self.components for port in component.clients]
        return [
            *(f"{port.id} -> {reader.id}" for port in outputs for reader in port.readers),
            *(f"{server.id} -> {port.id}" for port in clients for server in port.servers),
        ]

    def sort_readers(self):
        """Bring the readers of each output into the order of the model, in which data arrives."""
        inputs = [port for component in self.components for port in component.inputs]
        ranks = {port: rank for rank, port in enumerate(inputs)}
        for component in self.components:
            for port in component.outputs:
                port.readers.sort(key=ranks.__getitem__)
