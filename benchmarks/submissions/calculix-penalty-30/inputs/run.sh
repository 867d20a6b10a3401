python benchmarks/peers/board.py --keep --codes calculix-penalty-30 --problems 'PS-*'
