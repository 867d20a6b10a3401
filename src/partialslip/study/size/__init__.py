"""When a half-plane describes a body of a size: the study of sizes."""
