python benchmarks/peers/board.py --keep --codes opensees --problems 'PS-*'
