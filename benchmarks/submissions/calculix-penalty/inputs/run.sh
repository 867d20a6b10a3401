python benchmarks/peers/board.py --keep --codes calculix-penalty --problems 'PS-*'
