python benchmarks/peers/board.py --keep --codes calculix-mortar --problems 'PS-*'
