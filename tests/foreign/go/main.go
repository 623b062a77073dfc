// A planner that speaks carproof's protocol: start, query, plan (by CARP, in the order given), stop.
// With --bug NAME one bug is planted. With --one-shot INSTANCE SOLUTION it plans a file into a file.
package main

import (
	"bufio"
	"bytes"
	"encoding/json"
	"fmt"
	"os"
)

// id is a string or a number, as it is written in JSON.
type id string

func (i *id) UnmarshalJSON(data []byte) error {
	*i = id(data)
	return nil
}

func (i id) MarshalJSON() ([]byte, error) { return []byte(i), nil }

type instanceDocument struct {
	Graph struct {
		Directed bool
		Nodes    []struct {
			ID                 id
			Capacity, Duration *int
		}
		Edges []struct{ Source, Target id }
	}
	AfterGoal string `json:"after_goal"`
	Robots    []struct {
		ID, Start, Goal id
		Release         int
		Pace            *int
	}
}

type planDocument struct {
	Robot  id      `json:"robot"`
	Visits [][]any `json:"visits"`
}

type solutionDocument struct {
	Format    string         `json:"format"`
	Plans     []planDocument `json:"plans"`
	Order     []id           `json:"order"`
	Unplanned []id           `json:"unplanned"`
}

type request struct {
	ID       json.RawMessage
	Op       string
	Instance instanceDocument
	Solution struct {
		Plans []struct {
			Robot  id
			Visits [][3]json.RawMessage
		}
	}
	Robot   id
	Now     int
	Planner string
}

func orOne(value *int) int {
	if value == nil {
		return 1
	}
	return *value
}

// named is an instance with the ids of its resources and robots.
type named struct {
	instance
	resourceIDs, robotIDs []id
	index                 map[id]int
}

func read(document instanceDocument, bug string) named {
	n := named{instance: instance{park: document.AfterGoal == "park"}, index: map[id]int{}}
	for i, each := range document.Graph.Nodes {
		n.index[each.ID] = i
		n.resourceIDs = append(n.resourceIDs, each.ID)
		n.resources = append(n.resources, resource{orOne(each.Capacity), orOne(each.Duration), nil})
	}
	for _, edge := range document.Graph.Edges {
		source, target := n.index[edge.Source], n.index[edge.Target]
		n.resources[source].successors = append(n.resources[source].successors, target)
		if !document.Graph.Directed || bug == "directions-ignored" {
			n.resources[target].successors = append(n.resources[target].successors, source)
		}
	}
	for _, each := range document.Robots {
		n.robotIDs = append(n.robotIDs, each.ID)
		n.robots = append(n.robots, robot{n.index[each.Start], n.index[each.Goal], each.Release, orOne(each.Pace)})
	}
	return n
}

func (n named) visits(raw [][3]json.RawMessage) ([]visit, error) {
	var plan []visit
	for _, each := range raw {
		v := visit{resource: n.index[id(each[0])], leave: forever}
		if err := json.Unmarshal(each[1], &v.enter); err != nil {
			return nil, err
		}
		if string(each[2]) != "null" {
			if err := json.Unmarshal(each[2], &v.leave); err != nil {
				return nil, err
			}
		}
		plan = append(plan, v)
	}
	return plan, nil
}

func (n named) written(plan []visit) [][]any {
	visits := [][]any{}
	for _, each := range plan {
		var leave any = each.leave
		if each.leave == forever {
			leave = nil
		}
		visits = append(visits, []any{n.resourceIDs[each.resource], each.enter, leave})
	}
	return visits
}

func query(asked request, bug string) (any, error) {
	n := read(asked.Instance, bug)
	planner := newPlanner(n.instance, bug)
	var before []visit
	for _, each := range asked.Solution.Plans {
		plan, err := n.visits(each.Visits)
		if err != nil {
			return nil, err
		}
		if each.Robot == asked.Robot {
			before = plan
		} else {
			planner.commit(plan)
		}
	}
	for i, robot := range n.robotIDs {
		if robot == asked.Robot {
			if plan, found := planner.query(i, before, asked.Now); found {
				return map[string]any{"plan": n.written(plan)}, nil
			}
			return map[string]any{"plan": nil}, nil
		}
	}
	return nil, fmt.Errorf("there is no robot %s", asked.Robot)
}

func planAll(document instanceDocument, bug string) solutionDocument {
	n := read(document, bug)
	planner := newPlanner(n.instance, bug)
	solution := solutionDocument{"carproof-solution/1", []planDocument{}, []id{}, []id{}}
	for i, robot := range n.robotIDs {
		if plan, found := planner.query(i, nil, 0); found {
			planner.commit(plan)
			solution.Plans = append(solution.Plans, planDocument{robot, n.written(plan)})
			solution.Order = append(solution.Order, robot)
		} else {
			solution.Unplanned = append(solution.Unplanned, robot)
		}
	}
	return solution
}

func answer(asked request, bug string) (string, any) {
	switch {
	case asked.Op == "start":
		ops := []string{"start", "query", "plan", "stop"}
		return "result", map[string]any{"name": "carp in Go", "version": "1", "ops": ops}
	case asked.Op == "stop":
		return "result", map[string]any{}
	case asked.Op == "query":
		result, err := query(asked, bug)
		if err != nil {
			return refusal(err)
		}
		return "result", result
	case asked.Op == "plan" && asked.Planner == "carp":
		return "result", planAll(asked.Instance, bug)
	}
	return "skipped", "this is not offered"
}

func refusal(err error) (string, any) {
	return "error", map[string]any{"kind": "request", "path": "$", "rule": nil, "message": err.Error()}
}

func serve(bug string) {
	lines := bufio.NewScanner(os.Stdin)
	lines.Buffer(nil, 1<<26)
	for lines.Scan() {
		asked := request{ID: json.RawMessage("null")}
		decoder := json.NewDecoder(bytes.NewReader(lines.Bytes()))
		field, value := "", any(nil)
		if err := decoder.Decode(&asked); err != nil {
			field, value = refusal(err)
		} else {
			field, value = answer(asked, bug)
		}
		line, _ := json.Marshal(map[string]any{"id": asked.ID, field: value})
		fmt.Println(string(line))
		if asked.Op == "stop" {
			return
		}
	}
}

func planFile(from, to, bug string) error {
	data, err := os.ReadFile(from)
	if err != nil {
		return err
	}
	var document instanceDocument
	if err := json.Unmarshal(data, &document); err != nil {
		return err
	}
	written, _ := json.Marshal(planAll(document, bug))
	return os.WriteFile(to, written, 0o644)
}

func main() {
	arguments, bug := os.Args[1:], ""
	if len(arguments) >= 2 && arguments[0] == "--bug" {
		bug, arguments = arguments[1], arguments[2:]
	}
	if len(arguments) != 3 || arguments[0] != "--one-shot" {
		serve(bug)
		return
	}
	if err := planFile(arguments[1], arguments[2], bug); err != nil {
		fmt.Fprintln(os.Stderr, err)
		os.Exit(2)
	}
}
