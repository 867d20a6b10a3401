"""Studies: many cases of a scene, each finished one kept, and what they say together."""
