python benchmarks/peers/board.py --keep --codes equivalent --problems 'PS-*'
