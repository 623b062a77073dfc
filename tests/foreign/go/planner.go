package main

import (
	"container/heap"
	"math"
	"sort"
)

const forever = math.MaxInt64 / 4

type resource struct {
	capacity, duration int
	successors         []int
}

type robot struct {
	start, goal, release, pace int
}

type instance struct {
	resources []resource
	robots    []robot
	park      bool
}

type visit struct {
	resource, enter, leave int
}

type window struct {
	start, end int
}

type move struct {
	tick, source, target int
}

// planner holds what the committed plans leave free. bug names the bug that is planted, if any.
type planner struct {
	of    instance
	bug   string
	stays map[int][]visit
	moves map[move]bool
}

func newPlanner(of instance, bug string) *planner {
	return &planner{of, bug, map[int][]visit{}, map[move]bool{}}
}

func (p *planner) commit(plan []visit) {
	for i, each := range plan {
		if p.bug == "blocks-for-ever" && i == len(plan)-1 {
			each.leave = forever
		}
		p.stays[each.resource] = append(p.stays[each.resource], each)
		if i+1 < len(plan) {
			p.moves[move{plan[i+1].enter, each.resource, plan[i+1].resource}] = true
		}
	}
}

func (p *planner) ticks(robot, resource int) int {
	if p.bug == "pace-ignored" {
		return p.of.resources[resource].duration
	}
	return p.of.robots[robot].pace * p.of.resources[resource].duration
}

// windows sweeps over the ticks at which somebody comes or goes.
func (p *planner) windows(at int) []window {
	change := map[int]int{0: 0}
	for _, stay := range p.stays[at] {
		change[stay.enter]++
		if stay.leave < forever {
			change[stay.leave]--
		}
	}
	var ticks []int
	for tick := range change {
		ticks = append(ticks, tick)
	}
	sort.Ints(ticks)
	var free []window
	inside, opened := 0, -1
	for _, tick := range ticks {
		inside += change[tick]
		if opened < 0 && inside < p.of.resources[at].capacity {
			opened = tick
		} else if opened >= 0 && inside >= p.of.resources[at].capacity {
			free = append(free, window{opened, tick})
			opened = -1
		}
	}
	if opened >= 0 {
		free = append(free, window{opened, forever})
	}
	return free
}

func (p *planner) windowAround(v visit) (window, bool) {
	for _, free := range p.windows(v.resource) {
		if free.start <= v.enter && v.leave <= free.end {
			return free, true
		}
	}
	return window{}, false
}

func (p *planner) allows(visits []visit) bool {
	for i, each := range visits {
		if _, fits := p.windowAround(each); !fits {
			return false
		}
		if i > 0 && p.moves[move{each.enter, each.resource, visits[i-1].resource}] {
			return false
		}
	}
	return true
}

// history is what the robot has done by now; its last visit is the current one, left as early as it may be.
func (p *planner) history(of int, before []visit, now int) []visit {
	var done []visit
	for _, each := range before {
		if each.enter <= now {
			done = append(done, each)
		}
	}
	request := p.of.robots[of]
	if len(done) == 0 || p.bug == "history-forgotten" {
		release := request.release
		if p.bug == "release-ignored" {
			release = 0
		}
		done = []visit{{resource: request.start, enter: release}}
	}
	current := &done[len(done)-1]
	current.leave = current.enter + p.ticks(of, current.resource)
	if current.leave < now && p.bug != "history-forgotten" {
		current.leave = now
	}
	return done
}

// query returns the plan that arrives first; before is the plan that the robot has followed until now, if any.
func (p *planner) query(of int, before []visit, now int) ([]visit, bool) {
	if n := len(before); n > 0 && before[n-1].leave <= now && p.bug != "history-forgotten" {
		return before, p.allows(before)
	}
	past := p.history(of, before, now)
	if !p.allows(past) {
		return nil, false
	}
	return p.search(of, past, now)
}

type node struct {
	resource     int
	free         window
	enter, ready int
	parent       *node
}

// queue is ordered by the tick of entering.
type queue []*node

func (q queue) Len() int           { return len(q) }
func (q queue) Less(i, j int) bool { return q[i].enter < q[j].enter }
func (q queue) Swap(i, j int)      { q[i], q[j] = q[j], q[i] }
func (q *queue) Push(each any)     { *q = append(*q, each.(*node)) }
func (q *queue) Pop() any {
	last := (*q)[len(*q)-1]
	*q = (*q)[:len(*q)-1]
	return last
}

type place struct {
	resource int
	free     window
}

func (p *planner) search(of int, past []visit, now int) ([]visit, bool) {
	current := past[len(past)-1]
	free, _ := p.windowAround(current)
	open := &queue{{current.resource, free, current.enter, current.leave, nil}}
	reached := map[place]int{}
	for open.Len() > 0 {
		at := heap.Pop(open).(*node)
		if p.canEnd(of, at, now) {
			return p.unwind(of, past, at), true
		}
		for _, target := range p.of.resources[at.resource].successors {
			for _, into := range p.windows(target) {
				next, possible := p.enter(of, at, target, into)
				key := place{target, into}
				if p.bug == "one-window-each" {
					key.free = window{}
				}
				known, seen := reached[key]
				if possible && (!seen || next.enter < known) {
					reached[key] = next.enter
					heap.Push(open, next)
				}
			}
		}
		if p.bug == "first-found" && open.Len() > 0 {
			*open = (*open)[:1]
		}
	}
	return nil, false
}

// enter goes from a node into a window as early as possible.
func (p *planner) enter(of int, from *node, target int, into window) (*node, bool) {
	tick := max(from.ready, into.start)
	for p.moves[move{tick, target, from.resource}] {
		tick++
	}
	if p.bug == "no-waiting" && tick > from.ready {
		return nil, false
	}
	stay := p.ticks(of, target)
	return &node{target, into, tick, tick + stay, from}, tick <= from.free.end && tick+stay <= into.end
}

func (p *planner) canEnd(of int, at *node, now int) bool {
	if at.resource != p.of.robots[of].goal {
		return false
	}
	if p.of.park {
		return at.free.end == forever
	}
	return at.enter+p.ticks(of, at.resource) >= now || p.bug == "history-forgotten"
}

func (p *planner) unwind(of int, past []visit, last *node) []visit {
	leave := forever
	if !p.of.park {
		leave = last.enter + p.ticks(of, last.resource)
	}
	backward := []visit{{last.resource, last.enter, leave}}
	for at := last; at.parent != nil; at = at.parent {
		backward = append(backward, visit{at.parent.resource, at.parent.enter, at.enter})
	}
	plan := append([]visit{}, past[:len(past)-1]...)
	for i := len(backward) - 1; i >= 0; i-- {
		plan = append(plan, backward[i])
	}
	return plan
}
