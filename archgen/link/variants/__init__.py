"""How the project stands in a variant: what it is built on, what it takes out and what it writes, as one merged tree."""
