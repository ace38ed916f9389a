"""What rests on a partner or on some components, and what a partner has to do: by what rests on it."""
