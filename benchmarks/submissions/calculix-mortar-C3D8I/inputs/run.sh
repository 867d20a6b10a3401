python benchmarks/peers/board.py --keep --codes calculix-mortar-C3D8I --problems 'PS-*'
