"""Files of the Node Definition Language: component types with ports and parameters."""
