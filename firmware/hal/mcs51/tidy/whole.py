"""The rules over a whole program: callees before their callers, each as long as anything changes."""
from flow import Flow
from carried import put_at_once
from far import mend
from homes import find_homes, find_safer
from inline import inline
from jumps import Ways
from own import own_memory
from place import follow
from simpler import Simplifier
from strides import add_up
from thread import Threads
from unread import Unread

ROUNDS = 6


def bottom_up(program, flow):
    done, order = set(), []

    def visit(function):
        if function in done:
            return
        done.add(function)
        for line in function.code:
            callee = flow.callee(function, line) if line.op and flow.leaves(function, line) else None
            if callee:
                visit(callee)
        order.append(function)

    for function in program.functions:
        visit(function)
    return order


def tidy(program):
    flow = Flow(program)
    order = bottom_up(program, flow)
    for function in order:
        if function not in flow.wanted:
            continue
        if function.may_change():
            improve(program, flow, function)
            if inline(program, flow, function):
                improve(program, flow, function)
            if find_homes(program, flow, function, own_memory(program, flow, function)) | find_safer(flow, function):
                flow.forget(function)
                improve(program, flow, function)
        flow.forget(function)  # of one that stays as it is, too: what it calls may have changed
    flow = Flow(program)
    for function in [function for function in order if function in flow.wanted]:
        if function.may_change():
            improve(program, flow, function)
            add_up(program, flow, function)
            mend(function)
        flow.forget(function)


def improve(program, flow, function):
    for _ in range(ROUNDS):
        ways = Ways(function).run() | follow(function)
        ways |= Threads(program, flow, function, own_memory(program, flow, function)).run()
        ways |= put_at_once(program, flow, function)
        simpler = Simplifier(program, flow, function, own_memory(program, flow, function)).run()
        unread = Unread(program, flow, function, own_memory(program, flow, function)).run()
        if not (ways or simpler or unread):
            break
