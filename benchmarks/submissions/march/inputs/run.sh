python benchmarks/peers/board.py --keep --codes march --problems 'PS-*'
