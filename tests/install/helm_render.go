// SPDX-License-Identifier: Apache-2.0
// Renders the templates of a chart as Helm does: by text/template, Helm's own language, with those of Helm's
// functions that our chart calls. Any other function is an error, as is a value that the chart does not have.
//
// Reads {"context": {"Values": ..., "Chart": ..., "Release": ...}, "templates": {NAME: TEXT}} from the standard
// input, and writes YAML documents.
package main

import (
	"encoding/json"
	"fmt"
	"log"
	"os"
	"sort"
	"strings"
	"text/template"
)

type input struct {
	Context   map[string]any    `json:"context"`
	Templates map[string]string `json:"templates"`
}

// As sprig's, which take 0, "" and false for empty.
func orDefault(otherwise, given any) any {
	if truth, _ := template.IsTrue(given); truth {
		return given
	}
	return otherwise
}

func quote(value any) string { return fmt.Sprintf("%q", fmt.Sprint(value)) }

func toJSON(value any) (string, error) {
	text, err := json.Marshal(value)
	return string(text), err
}

func main() {
	log.SetFlags(0)
	var given input
	if err := json.NewDecoder(os.Stdin).Decode(&given); err != nil {
		log.Fatal(err)
	}
	functions := template.FuncMap{"default": orDefault, "quote": quote, "toJson": toJSON}
	names := make([]string, 0, len(given.Templates))
	for name := range given.Templates {
		names = append(names, name)
	}
	sort.Strings(names)
	for _, name := range names {
		parsed, err := template.New(name).Funcs(functions).Option("missingkey=error").Parse(given.Templates[name])
		if err != nil {
			log.Fatal(err)
		}
		var object strings.Builder
		if err := parsed.Execute(&object, given.Context); err != nil {
			log.Fatal(err)
		}
		if strings.TrimSpace(object.String()) != "" {
			fmt.Println("---\n" + object.String())
		}
	}
}
