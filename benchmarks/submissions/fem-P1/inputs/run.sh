python benchmarks/peers/board.py --keep --codes fem-P1 --problems 'PS-*'
