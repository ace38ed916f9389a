"""Use cases as sequences: who says what to whom, along which connection, and how soon."""
