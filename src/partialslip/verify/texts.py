"""What makes each family of the catalogue hard, in words."""

FAMILIES: dict[str, tuple[str, str]] = {n: (n, n) for n in (
    "near-sliding", "near-stuck", "transition", "huge-tension", "no-shear", "no-tension", "beside", "poisson",
    "friction", "sharp", "mean-loads", "cycles", "few-nodes", "meshes", "mirrored")}
