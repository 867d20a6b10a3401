python benchmarks/peers/board.py --keep --codes fem-1e-3 --problems 'PS-*'
