-- The emergency messages, and the rate of the frames of each service, from the lines of JSON.
SELECT time_us / 1e6 AS time, node, format('{:04X}h', error_code) AS error, text
FROM read_json('heater.jsonl', format = 'newline_delimited')
WHERE service = 'emcy'
ORDER BY line;

SELECT service, count(*) AS frames, round(count(*) * 1e6 / (max(time_us) - min(time_us)), 1) AS per_second
FROM read_json('heater.jsonl', format = 'newline_delimited')
GROUP BY service
HAVING count(*) > 1
ORDER BY service;
