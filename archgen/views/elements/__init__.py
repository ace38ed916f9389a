"""One element as blocks: a component or group at the high level, a node at the low level, the card of `archgen show`."""
