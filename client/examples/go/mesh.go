// SPDX-License-Identifier: Apache-2.0

// Meshes a plate with a hole, finer towards the hole, and prints what came:
//
//	mesh [ANGLE]
//
// ANGLE is the minimum angle in degrees. The server is WEFT_SERVER, by default 127.0.0.1:7421;
// WEFT_TOKEN its token, WEFT_TLS_CA the certificates by which to trust it: without them the
// connection is not encrypted. README.md says how to compile it.
package main

import (
	"bytes"
	"context"
	"crypto/sha256"
	"fmt"
	"io"
	"log"
	"math"
	"os"
	"strconv"
	"time"

	"google.golang.org/genproto/googleapis/rpc/errdetails"
	"google.golang.org/grpc"
	"google.golang.org/grpc/credentials"
	"google.golang.org/grpc/metadata"
	"google.golang.org/grpc/status"
	"google.golang.org/protobuf/proto"

	weftv1 "weft/v1"
)

// A ring of count points from first: its segments, all with one marker.
func addRing(domain *weftv1.Domain, first, count uint32, marker int32) {
	for i := uint32(0); i < count; i++ {
		domain.Segments = append(domain.Segments, first+i, first+(i+1)%count)
		domain.SegmentMarkers = append(domain.SegmentMarkers, marker)
	}
}

func plateWithHole() *weftv1.Domain {
	domain := &weftv1.Domain{
		Points: []float64{0, 0, 10, 0, 10, 6, 0, 6},
		Holes:  []float64{3, 3}, // a seed in the face to carve away
	}
	addRing(domain, 0, 4, 1)
	for i := 0; i < 24; i++ {
		angle := float64(i) * math.Pi / 12
		domain.Points = append(domain.Points, 3+math.Cos(angle), 3+math.Sin(angle))
	}
	addRing(domain, 4, 24, 2)
	return domain
}

type mesh struct {
	points    []float64 // x0, y0, x1, y1, ...
	triangles []uint32  // three vertex numbers each
	chunks    uint32
	summary   *weftv1.Summary
}

// Receives the chunks of a mesh in their order. Vertices are numbered across all of them. A stream
// without a summary is not a mesh, nor is one whose chunks are not those of the summary.
func receive(stream weftv1.MeshService_GenerateMeshClient) (*mesh, error) {
	received := &mesh{}
	digest := sha256.New()
	for {
		response, err := stream.Recv()
		if err == io.EOF {
			break
		}
		if err != nil {
			return nil, err
		}
		if chunk := response.GetChunk(); chunk != nil {
			if chunk.Index != received.chunks {
				return nil, fmt.Errorf("chunk %d is out of order", chunk.Index)
			}
			received.chunks++
			received.points = append(received.points, chunk.Coordinates...)
			received.triangles = append(received.triangles, chunk.Triangles...)
			digest.Write(chunk.Sha256)
		}
		if summary := response.GetSummary(); summary != nil {
			received.summary = summary
		}
	}
	if received.summary == nil {
		return nil, fmt.Errorf("the stream ended without a summary")
	}
	if !bytes.Equal(digest.Sum(nil), received.summary.Sha256) {
		return nil, fmt.Errorf("the mesh is damaged")
	}
	return received, nil
}

func connect() (*grpc.ClientConn, error) {
	server := os.Getenv("WEFT_SERVER")
	if server == "" {
		server = "127.0.0.1:7421"
	}
	encryption := grpc.WithInsecure()
	if ca := os.Getenv("WEFT_TLS_CA"); ca != "" {
		trusted, err := credentials.NewClientTLSFromFile(ca, "")
		if err != nil {
			return nil, err
		}
		encryption = grpc.WithTransportCredentials(trusted)
	}
	return grpc.Dial(server, encryption)
}

func generate(minAngle float64) (*mesh, error) {
	connection, err := connect()
	if err != nil {
		return nil, err
	}
	defer connection.Close()
	// Ends the work, too, if it takes longer.
	ctx, cancel := context.WithTimeout(context.Background(), time.Minute)
	defer cancel()
	if token := os.Getenv("WEFT_TOKEN"); token != "" {
		ctx = metadata.AppendToOutgoingContext(ctx, "authorization", "Bearer "+token)
	}
	stream, err := weftv1.NewMeshServiceClient(connection).GenerateMesh(ctx,
		&weftv1.GenerateMeshRequest{
			Domain: plateWithHole(),
			Size: &weftv1.SizeField{
				Field:   &weftv1.SizeField_Expression{Expression: "0.05 + 0.1*(hypot(x - 3, y - 3) - 1)"},
				Measure: weftv1.Measure_MEASURE_EDGE,
			},
			Quality: &weftv1.Quality{MinAngleDeg: proto.Float64(minAngle)},
		})
	if err != nil {
		return nil, err
	}
	return receive(stream)
}

// The code of a status, its message, and the details that came with it.
func explain(failure *status.Status) {
	fmt.Fprintf(os.Stderr, "%s: %s\n", failure.Code(), failure.Message())
	for _, detail := range failure.Details() {
		switch detail := detail.(type) {
		case *errdetails.ErrorInfo:
			fmt.Fprintf(os.Stderr, "  reason %s\n", detail.Reason)
		case *errdetails.BadRequest:
			for _, violation := range detail.FieldViolations {
				fmt.Fprintf(os.Stderr, "  field %s\n", violation.Field)
			}
		case *errdetails.RetryInfo:
			fmt.Fprintf(os.Stderr, "  the same request may succeed in %d s\n",
				detail.RetryDelay.Seconds)
		}
	}
}

func main() {
	minAngle := 25.0
	if len(os.Args) > 1 {
		var err error
		if minAngle, err = strconv.ParseFloat(os.Args[1], 64); err != nil {
			log.Fatal(err)
		}
	}
	received, err := generate(minAngle)
	if failure, ok := status.FromError(err); !ok {
		log.Fatal(err)
	} else if err != nil {
		explain(failure)
		os.Exit(1)
	}
	summary := received.summary
	fmt.Printf("%d triangles, %d vertices in %d chunks, angles %.2f to %.2f degrees, area %.4f\n",
		len(received.triangles)/3, len(received.points)/2, received.chunks,
		summary.MinAngleDeg, summary.MaxAngleDeg, summary.Area)
}
