"""Studies: solve many cases of a scene, save each finished case, and evaluate the cases together."""
