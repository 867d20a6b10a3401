python benchmarks/peers/board.py --keep --codes opensees-bbar --problems 'PS-*'
