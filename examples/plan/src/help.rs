//! Help of `plan`.

/// Text of `plan --help`.
pub const HELP: &str = "\
Compiles a frame graph from a file without a GPU and prints the plan.

usage: plan FRAME.ron [options]
       plan --offsets FILE.csv [--budget-steps N] [--seconds S] [--out FILE]

FRAME.ron is a graph; docs/reference/graph-format.md documents its fields.

  --caps DEVICE       desktop, tiler, mali, adreno, apple, wgpu (default), wgpu-native, or a FILE.ron that describes a device
  --size WxH          frame size in texels; default: the size in the file, else 1920x1080
  --set FEATURE=on|off
                      enable or disable a feature of the file; repeatable
  --order ORDER       declared (default) or optimized
  --format FORMAT     text (default), json (docs/reference/plan-json.md), dot, mermaid or svg
  --diff OTHER.ron    print the changes from FRAME.ron to OTHER.ron for the same device, size and features, as text
                      or json; a feature that only one file has is set in that file
  --budget LIMITS     exit with code 1 and list the responsible decisions if a limit is exceeded.
                      LIMITS is NAME=MAX,... with these names:
                        loads     attachments loaded from memory (unresolves)
                        stores    attachments stored to memory (resolves)
                        steps     steps
                        culled    culled passes
                        bytes     memory of transient resources
                        traffic   bytes loaded and stored
                      bytes and traffic accept B, kB, MB, GB (powers of 1000), KiB, MiB and GiB (powers of 1024):
                        --budget loads=0,stores=3,bytes=200MB
  --queues LAYOUT     schedule the frame on several queues where that is faster: one, async-compute,
                      async-compute-and-copy, or device for the queues of --caps.
                      Prints the queue of each step, the waits and the frame time, as text or svg
  --costs FILE        cost of each pass for --queues, in lines `PASS,MICROSECONDS`; default: estimated from bytes
  --out FILE          write to FILE instead of standard output
  --offsets FILE.csv  pack intervals `id,lower,upper,size` (MiniMalloc's format) into one heap and print them with an
                      `offset` column. `start` and `begin` are synonyms of `lower`; `end` is an inclusive `upper`.
                      Top and lower bound go to standard error, every second during the search. A signal stops the
                      search and prints the best offsets found so far
  --budget-steps N    maximum number of search steps for --offsets (default 150000000)
  --seconds S         time limit of the search in seconds (default: none)
  --plugins           list the plugin kinds that files can name, with their slots
  --help              print this help

Exit codes: 0 success, 1 budget exceeded, 2 invalid input or output, 128 + N stopped by signal N.
";
