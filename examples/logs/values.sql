-- The number, range and mean of the values of each object, in its unit.
SELECT node, object, name, unit, count(*) AS values, min(physical::DOUBLE) AS min, max(physical::DOUBLE) AS max,
       round(avg(physical::DOUBLE), 3) AS mean
FROM read_csv('heater.csv', header = true, all_varchar = true)
WHERE object IS NOT NULL
GROUP BY ALL
ORDER BY object;

-- How long after a setpoint the first heating power follows, in milliseconds.
WITH changes AS (
  SELECT service, time::DOUBLE AS time, lead(service) OVER (ORDER BY line::BIGINT) AS next,
         lead(time::DOUBLE) OVER (ORDER BY line::BIGINT) AS next_time
  FROM read_csv('heater.csv', header = true, all_varchar = true)
  WHERE service IN ('rpdo', 'tpdo')
)
SELECT count(*) AS setpoints, round(max(next_time - time) * 1000, 1) AS longest_ms
FROM changes
WHERE service = 'rpdo' AND next = 'tpdo';
