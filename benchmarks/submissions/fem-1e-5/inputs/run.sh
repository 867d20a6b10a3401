python benchmarks/peers/board.py --keep --codes fem-1e-5 --problems 'PS-*'
