"""What each endpoint is on the wire, after all that a launch says: the record that everything else reads."""
