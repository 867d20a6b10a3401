"""The study of sizes: how large a body must be to act as a half-plane."""
