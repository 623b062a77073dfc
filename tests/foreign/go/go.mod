module carproof.test/foreign

go 1.21
